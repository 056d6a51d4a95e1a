// cli/run/gnuplot.h -- draws with gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace cordis::cli {

/// Text for gnuplot as it stands: between single quotes nothing but these means anything.
std::string gnuplot_quoted(const std::string& text);

/// @return true where gnuplot is installed
bool has_gnuplot();

/// Runs a script in its folder. @return true when gnuplot is installed and reports no error
bool run_gnuplot(const std::filesystem::path& script);

}  // namespace cordis::cli
