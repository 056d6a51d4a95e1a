// cli/film/film_writer.cpp
#include "cli/film/film_writer.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "cli/table/output_file.h"
#include "node/config/regular_file.h"

extern char** environ;

namespace cordis::cli {
namespace {

constexpr int kPipeSize =
    1 << 20;  // [bytes]: ffmpeg takes a part of an image while the next is drawn

bool has_ffmpeg() {
  const char* folders = std::getenv("PATH");
  std::string_view rest = folders == nullptr ? "" : folders;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::string program = std::string(rest.substr(0, end)) + "/ffmpeg";
    if (access(program.c_str(), X_OK) == 0) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::vector<std::string> ffmpeg_words(const std::string& path, int width, int height,
                                      double frames_per_s) {
  std::vector<std::string> words = {"ffmpeg",    "-y",
                                    "-loglevel", "error",
                                    "-xerror",  // a full disk at the end is no success
                                    "-f",        "rawvideo",
                                    "-pix_fmt",  "rgb24",
                                    "-s",        fmt::format("{}x{}", width, height),
                                    "-r",        fmt::format("{}", frames_per_s),
                                    "-i",        "-"};
  const std::vector<std::string> more =
      path.ends_with(".mp4")
          ? std::vector<std::string>{"-c:v", "libx264",  "-preset", "veryfast",  "-crf",
                                     "20",   "-pix_fmt", "yuv420p", "-movflags", "+faststart"}
          : std::vector<std::string>{"-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used",
                                     "8",    "-row-mt",    "1",         "-crf",     "32",
                                     "-b:v", "0",          "-pix_fmt",  "yuv420p"};
  words.insert(words.end(), more.begin(), more.end());
  words.push_back(path.starts_with("-") ? "./" + path : path);
  return words;
}

}  // namespace

FilmWriter::FilmWriter(std::string path, int width, int height, double frames_per_s)
    : path_(std::move(path)),
      width_(width),
      height_(height),
      frames_per_s_(frames_per_s),
      is_folder_(path_.ends_with("/")) {
  if (is_folder_) {
    std::error_code fault;
    std::filesystem::create_directories(path_, fault);
    if (fault) throw UsageError("cannot make the folder " + path_ + ": " + fault.message());
    return;
  }
  if (!path_.ends_with(".mp4") && !path_.ends_with(".webm")) {
    throw UsageError("-o '" + path_ +
                     "' is no film: name a file .mp4 or .webm, or a folder with / at its end");
  }
  if (!has_ffmpeg()) {
    throw UsageError("a film needs ffmpeg (apt install ffmpeg); without it write images: -o " +
                     path_.substr(0, path_.rfind('.')) + "/");
  }
  const std::string reason = config::reason_not_to_write(path_);
  if (!reason.empty()) throw UsageError("cannot write " + path_ + ": " + reason);
  const OutputFile is_possible(path_);
}

FilmWriter::~FilmWriter() {
  if (pipe_ >= 0) close(pipe_);
  if (ffmpeg_ > 0) waitpid(ffmpeg_, nullptr, 0);
}

void FilmWriter::start_ffmpeg() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("there is no pipe left");
  fcntl(ends[1], F_SETPIPE_SZ, kPipeSize);
  std::vector<std::string> words = ffmpeg_words(path_, width_, height_, frames_per_s_);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A group of its own: Ctrl-C ends the film properly, by the end of its input.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int fault =
      posix_spawnp(&ffmpeg_, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  pipe_ = ends[1];
  if (fault != 0) {
    ffmpeg_ = -1;
    throw std::runtime_error(std::string("cannot start ffmpeg: ") + std::strerror(fault));
  }
}

void FilmWriter::fail() {
  throw std::runtime_error("cannot write " + path_ + " whole; what ffmpeg says of it stands above");
}

void FilmWriter::write(const viz::Image& image) {
  ++count_;
  if (is_folder_) {
    OutputFile file(fmt::format("{}frame_{:05}.png", path_, count_));
    file.write(viz::png_of(image));
    file.flush();
    return;
  }
  if (pipe_ < 0) start_ffmpeg();
  const std::uint8_t* rest = image.bytes().data();
  std::size_t left = image.bytes().size();
  while (left > 0) {
    const ssize_t written = ::write(pipe_, rest, left);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail();
    rest += written;
    left -= static_cast<std::size_t>(written);
  }
}

void FilmWriter::finish() {
  if (pipe_ < 0) return;
  close(std::exchange(pipe_, -1));
  int status = 0;
  while (waitpid(ffmpeg_, &status, 0) < 0 && errno == EINTR) {
  }
  ffmpeg_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail();
}

}  // namespace cordis::cli
