// cli/resim/take_reader.h -- what a re-simulation needs of a take.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "cli/numbered_messages.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "record_node/mcap/reader.h"

namespace cordis::cli {

/// The inputs and frames of one life of sim_node in a take, each by their numbers: times of a clock
/// that was set back meanwhile may be in another order.
class TakeReader {
 public:
  /// Takes the first epoch whose inputs begin in the take, else the first there is.
  /// @throws mcap::FileError when it cannot be read; config::ConfigError-like sentences as
  /// std::invalid_argument when it holds no inputs
  explicit TakeReader(const std::string& path);

  /// The next batch of scene/inputs; false at the end.
  bool next(msg::SceneInputs& batch);
  /// The next frame; false at the end.
  bool next(msg::SceneFrame& frame);
  /// The scene as it was described; nullptr when the take has no such version.
  const msg::SceneDescription* description(std::uint64_t version) const noexcept;

  const mcap::Reader& file() const noexcept { return file_; }
  std::uint64_t epoch() const noexcept { return epoch_; }
  /// Other lives of sim_node in the take, which are left out.
  std::size_t other_epochs() const noexcept { return other_epochs_; }
  /// Frames of those that were passed over so far.
  std::uint64_t other_frames() const noexcept { return other_frames_; }
  /// Why not everything could be read; empty when it could.
  std::string loss() const;

 private:
  void choose_epoch();
  void read_descriptions();
  template <class Message>
  bool read(mcap::MessageCursor& cursor, Message& message);

  mcap::Reader file_;
  mcap::MessageCursor inputs_;
  mcap::MessageCursor frames_;
  NumberedMessages<msg::SceneInputs> numbered_inputs_;
  NumberedMessages<msg::SceneFrame> numbered_frames_;
  std::uint64_t epoch_ = 0;
  std::uint64_t newest_frame_ = 0;
  std::size_t other_epochs_ = 0;
  std::uint64_t other_frames_ = 0;
  std::uint64_t unreadable_ = 0;  // messages
  std::map<std::uint64_t, msg::SceneDescription> descriptions_;
};

}  // namespace cordis::cli
