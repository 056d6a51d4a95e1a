// cli/scene_source/figure_file.h -- a figure as SVG, PDF or PNG, by the name of its file.
#pragma once

#include <functional>
#include <string>

#include "viz_node/render/canvas.h"

namespace cordis::cli {

/// Throws when the name is missing or has another ending than .svg, .pdf or .png, or the file cannot
/// be written: before the work is done. @throws UsageError
void check_figure_file(const std::string& path);

/// Draws a figure and writes it.
/// @param width, height  [pixels]
/// @throws std::runtime_error when it cannot be written
void write_figure(const std::string& path, double width, double height,
                  const viz::Colour& background, const std::function<void(viz::Canvas&)>& draw);

}  // namespace cordis::cli
