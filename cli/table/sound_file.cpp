// cli/table/sound_file.cpp
#include "cli/table/sound_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <sndfile.h>
#include <soxr.h>

#include "cli/command_line.h"

namespace cordis::cli {
namespace {

constexpr std::size_t kBlock = 1024;  // frames at a time
constexpr std::size_t kRoom = 16384;  // frames that a resampler makes at a time
constexpr std::array<double, 11> kCardRates{8000,  11025, 16000, 22050,  32000, 44100,
                                            48000, 88200, 96000, 176400, 192000};

/// Describes a file of 32-bit floating point as a plain WAV file does.
///
/// libsndfile describes what may become an RF64 file by WAVE_FORMAT_EXTENSIBLE, which not every program
/// reads. Below 4 GiB it is a WAV file in the end, and the plain description takes 24 of the 48 bytes.
/// @return false if the file cannot be read or written
bool make_plain(const std::string& path) {
  constexpr std::size_t kFirstChunk = 12;
  constexpr std::uint32_t kExtensible = 40;                                 // bytes
  constexpr std::array<char, 6> kPlain{16, 0, 0, 0, 3, 0};                  // bytes, IEEE floats
  constexpr std::array<char, 24> kFiller{'J', 'U', 'N', 'K', 16, 0, 0, 0};  // and nothing
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  std::string head(256, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  if (!head.starts_with("RIFF")) return !head.empty();
  file.clear();  // a short file ends within the head
  for (std::size_t place = kFirstChunk; place + 8 <= head.size();) {
    std::uint32_t size = 0;
    std::memcpy(&size, head.data() + place + 4, sizeof size);
    if (head.compare(place, 4, "fmt ") != 0) {
      place += 8 + std::size_t{size};
      continue;
    }
    if (size != kExtensible) return true;
    file.seekp(static_cast<std::streamoff>(place + 4));
    file.write(kPlain.data(), kPlain.size());
    file.seekp(static_cast<std::streamoff>(place + 24));
    file.write(kFiller.data(), kFiller.size());
    return file.flush().good();
  }
  return false;
}

}  // namespace

double sound_rate_for(double step_rate_hz) noexcept {
  const bool is_usual = std::ranges::find(kCardRates, step_rate_hz) != kCardRates.end();
  return is_usual ? step_rate_hz : SoundFile::kUsualRate;
}

struct SoundFile::Impl {
  Impl(std::string file_path, std::vector<SoundChannel> sounds, double step_rate)
      : path(std::move(file_path)),
        channels(std::move(sounds)),
        step_rate_hz(step_rate),
        rate_hz(sound_rate_for(step_rate)) {
    SF_INFO info{};
    info.samplerate = static_cast<int>(rate_hz);
    info.channels = static_cast<int>(channels.size());
    info.format = SF_FORMAT_RF64 | SF_FORMAT_FLOAT;
    file = sf_open(path.c_str(), SFM_WRITE, &info);
    if (file == nullptr) throw UsageError("cannot write '" + path + "': " + sf_strerror(nullptr));
    sf_command(file, SFC_RF64_AUTO_DOWNGRADE, nullptr, SF_TRUE);
    if (rate_hz == step_rate_hz) return;
    soxr_error_t error = nullptr;
    const soxr_io_spec_t io = soxr_io_spec(SOXR_FLOAT64_I, SOXR_FLOAT32_I);
    const soxr_quality_spec_t quality = soxr_quality_spec(SOXR_VHQ, 0);
    resampler = soxr_create(step_rate_hz, rate_hz, static_cast<unsigned>(channels.size()), &error,
                            &io, &quality, nullptr);
    if (error != nullptr) {
      sf_close(file);
      throw std::runtime_error("cannot resample " + std::to_string(step_rate_hz) +
                               " Hz: " + soxr_strerror(error));
    }
    resampled.resize(channels.size() * kRoom);
  }
  ~Impl() {
    if (resampler != nullptr) soxr_delete(resampler);
    if (file != nullptr) sf_close(file);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[noreturn]] void fail() const {
    throw std::runtime_error("cannot write '" + path + "': " + sf_strerror(file));
  }

  void put(const float* samples, std::size_t frames) {
    for (std::size_t i = 0; i < frames * channels.size(); ++i)
      peak = std::max(peak, std::abs(static_cast<double>(samples[i])));
    const auto wanted = static_cast<sf_count_t>(frames);
    if (sf_writef_float(file, samples, wanted) != wanted) fail();
  }

  /// What is waiting goes to the file; with `is_last` also what the resampler still holds.
  void drain(bool is_last) {
    const std::size_t frames = waiting.size() / channels.size();
    if (resampler == nullptr) {
      resampled.assign(waiting.begin(), waiting.end());
      put(resampled.data(), frames);
      waiting.clear();
      return;
    }
    const std::size_t room = resampled.size() / channels.size();
    std::size_t taken = 0;
    while (taken < frames) {
      std::size_t used = 0;
      std::size_t count = 0;
      soxr_process(resampler, waiting.data() + taken * channels.size(), frames - taken, &used,
                   resampled.data(), room, &count);
      taken += used;
      put(resampled.data(), count);
    }
    waiting.clear();
    for (std::size_t count = 1; is_last && count > 0;) {
      soxr_process(resampler, nullptr, 0, nullptr, resampled.data(), room, &count);
      put(resampled.data(), count);
    }
  }

  std::string path;
  std::vector<SoundChannel> channels;
  double step_rate_hz;
  double rate_hz;
  double peak = 0.0;
  SNDFILE* file = nullptr;
  soxr_t resampler = nullptr;
  std::vector<double> waiting;  // for the file, in parts of full scale
  std::vector<float> resampled;
};

SoundFile::SoundFile(const std::string& path, std::vector<SoundChannel> channels,
                     double step_rate_hz)
    : impl_(std::make_unique<Impl>(path, std::move(channels), step_rate_hz)) {}

SoundFile::~SoundFile() = default;

void SoundFile::write(std::span<const double> values) {
  for (std::size_t c = 0; c < values.size(); ++c)
    impl_->waiting.push_back(values[c] / impl_->channels[c].full_scale);
  if (impl_->waiting.size() >= kBlock * values.size()) impl_->drain(/*is_last=*/false);
}

void SoundFile::finish() {
  impl_->drain(/*is_last=*/true);
  const int error = sf_close(std::exchange(impl_->file, nullptr));
  if (error != 0)
    throw std::runtime_error("cannot write '" + impl_->path + "': " + sf_error_number(error));
  if (!make_plain(impl_->path)) throw std::runtime_error("cannot write '" + impl_->path + "'");
}

double SoundFile::rate_hz() const noexcept {
  return impl_->rate_hz;
}

double SoundFile::peak() const noexcept {
  return impl_->peak;
}

}  // namespace cordis::cli
