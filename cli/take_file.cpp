// cli/take_file.cpp
#include "cli/take_file.h"

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "cli/duration.h"
#include "node/config/count_text.h"
#include "record_node/mcap/file_error.h"

namespace cordis::cli {

std::unique_ptr<mcap::Reader> open_take(const std::string& verb, const std::string& file) {
  std::error_code ignored;
  const std::string unfinished = file + ".part";
  if (!std::filesystem::exists(file, ignored) && std::filesystem::exists(unfinished, ignored)) {
    throw UsageError("there is no " + file + ", but " + unfinished +
                     ", which no recorder has closed: `cordis recover " + unfinished +
                     "` repairs it, unless it is still recorded");
  }
  try {
    auto reader = std::make_unique<mcap::Reader>(file);
    if (!reader->is_whole())
      std::fprintf(stderr, "cordis %s: %s (`cordis recover` repairs it)\n", verb.c_str(),
                   reader->damage().c_str());
    return reader;
  } catch (const mcap::FileError& error) {
    throw UsageError(error.what());
  }
}

std::uint64_t start_offset_in(const mcap::Reader& take, const std::string& offset) {
  const mcap::Statistics& all = take.statistics();
  const auto offset_nsec = static_cast<std::uint64_t>(parse_offset(offset).count());
  if (offset_nsec > all.end_nsec - all.start_nsec)
    throw UsageError(
        fmt::format("--start-offset {} is beyond the end of the take, which lasts {:.3f} s", offset,
                    1e-9 * static_cast<double>(all.end_nsec - all.start_nsec)));
  return offset_nsec;
}

std::unique_ptr<mcap::Writer> make_take(const std::string& file, const std::string& compression) {
  mcap::WriterConfig config;
  const auto named = mcap::compression_named(compression);
  if (!named) throw UsageError("--compression is none, lz4 or zstd, not '" + compression + "'");
  config.compression = *named;
  config.library = "cordis " CORDIS_VERSION;
  try {
    return std::make_unique<mcap::Writer>(file, config);
  } catch (const mcap::FileError& error) {
    std::error_code unknown;
    if (std::filesystem::exists(file, unknown)) throw UsageError(error.what());
    throw;
  }
}

void finish_take(const std::string& verb, mcap::Writer& writer,
                 const std::vector<std::string>& problems) {
  if (writer.close() != mcap::WriteStatus::kOk) throw mcap::FileError(writer.problem());
  std::printf("%s: %s\n", writer.path().c_str(),
              config::count_text(writer.statistics().message_count, "message").c_str());
  for (const std::string& problem : problems)
    std::fprintf(stderr, "cordis %s: %s\n", verb.c_str(), problem.c_str());
}

std::string size_text(std::uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} bytes", bytes);
  double size = 1e-3 * static_cast<double>(bytes);
  const char* unit = "kB";
  for (const char* larger : {"MB", "GB"}) {
    if (size < 999.5) break;
    size *= 1e-3;
    unit = larger;
  }
  return fmt::format("{:.3g} {}", size, unit);
}

}  // namespace cordis::cli
