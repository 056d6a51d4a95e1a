// cli/table/sound_file.h -- signals of a scene as a sound file.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cordis::cli {

/// One channel of a sound file.
struct SoundChannel {
  std::string name;
  double full_scale = 1.0;  ///< the value that becomes the sample 1, > 0
};

/// A WAV file of 32-bit floating point with the plain header, one channel per sound. Beyond 4 GiB
/// it is an RF64 file. Where the rate of the steps is none of a sound card it is resampled to
/// kUsualRate. The quality is SOXR_VHQ of libsoxr: 28 bits, pass band to 0.913 of the lower Nyquist
/// frequency. Values beyond full scale are kept: they are louder than 1, and cut off by a player
/// alone.
class SoundFile {
 public:
  static constexpr double kUsualRate = 48000.0;  ///< [1/s]

  /// @throws UsageError when the file cannot be made.
  SoundFile(const std::string& path, std::vector<SoundChannel> channels, double step_rate_hz);
  ~SoundFile();
  SoundFile(const SoundFile&) = delete;
  SoundFile& operator=(const SoundFile&) = delete;

  /// One value per channel, of one step. @throws std::runtime_error when the file takes no more.
  void write(std::span<const double> values);
  /// Completes the file; to be called once. @throws likewise.
  void finish();

  double rate_hz() const noexcept;  ///< sampling rate of the file
  /// The largest sample so far, by its amount; 1 is full scale.
  double peak() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The rate of a sound file for steps of this rate.
double sound_rate_for(double step_rate_hz) noexcept;

}  // namespace cordis::cli
