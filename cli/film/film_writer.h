// cli/film/film_writer.h -- images as a film, or as files in a folder.
#pragma once

#include <cstdint>
#include <string>

#include <sys/types.h>

#include "viz_node/render/image.h"

namespace cordis::cli {

/// Writes MP4 (H.264) or WebM (VP9) with the program ffmpeg, or PNG files with numbers. A film that was
/// there before stays until the first image.
class FilmWriter {
 public:
  /// @param path  name.mp4, name.webm, or a folder with a `/` at its end, which is made
  /// @throws UsageError when the name is none of these, nothing can be written there, or ffmpeg is
  /// not installed
  FilmWriter(std::string path, int width, int height, double frames_per_s);
  ~FilmWriter();
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;

  /// @throws std::runtime_error when it cannot be written.
  void write(const viz::Image& image);
  /// Waits until everything is written. @throws likewise.
  void finish();

  std::uint64_t count() const noexcept { return count_; }  ///< images written

 private:
  void start_ffmpeg();
  [[noreturn]] void fail();

  std::string path_;
  int width_;
  int height_;
  double frames_per_s_;
  bool is_folder_;
  pid_t ffmpeg_ = -1;
  int pipe_ = -1;
  std::uint64_t count_ = 0;
};

}  // namespace cordis::cli
