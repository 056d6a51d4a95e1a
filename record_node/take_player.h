// record_node/take_player.h -- publishes a take on DDS, as its session published it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/dds/security.h"
#include "node/session_key.h"

namespace cordis::record {

/// How many times as fast as it was recorded a take can be played.
inline constexpr double kSlowestRate = 1e-3;
inline constexpr double kFastestRate = 1e3;

/// What is played, and where to.
struct TakePlayerConfig {
  std::filesystem::path take;
  int domain = 0;
  std::string session;
  std::optional<node::SessionKey> key{};  ///< key of the session
  dds::Security security{};               ///< on: the session is secured
  double rate = 1.0;                      ///< kSlowestRate to kFastestRate
  bool loop = false;
  bool paused = false;                          ///< at the start
  bool waits_for_readers = false;               ///< for one of each topic, before it begins
  double start_s = 0.0;                         ///< from the start of the take
  std::optional<double> duration_s;             ///< length to play; absent: to the end of the take
  std::vector<std::string> topics;              ///< patterns; empty: all but control/*
  std::vector<std::string> excluded;            ///< patterns
  std::map<std::string, std::string> remapped;  ///< names of topics, and those they are played as
};

/// Where a player is.
struct TakePlayerFigures {
  double position_s = 0.0;  ///< from the start of the take
  double length_s = 0.0;    ///< length of the take
  double rate = 1.0;
  bool paused = false;
  bool is_over = false;  ///< all was played
  std::uint64_t messages = 0;
  std::uint64_t failed = 0;  ///< messages that DDS did not take
};

/// Plays a take in threads of its own, and answers `pause`, `resume`, `step`, `reset`, `seek` and
/// `rate` as the sim_node of the session would: the take has no other. Payloads stay as they are.
/// Topics that are kept for late joiners are so here, also after a jump. It plays the node/status of
/// sim_node and devices, not those of viewers and recorders.
class TakePlayer {
 public:
  /// @throws mcap::FileError when the take cannot be read, std::runtime_error when there is nothing
  /// to play or DDS refuses
  explicit TakePlayer(TakePlayerConfig config);
  ~TakePlayer();
  TakePlayer(const TakePlayer&) = delete;
  TakePlayer& operator=(const TakePlayer&) = delete;

  TakePlayerFigures figures() const;
  /// What is wrong with the take; empty when it is whole.
  const std::string& damage() const noexcept;

  // Any thread, at any time.
  void pause(bool paused);
  /// Plays messages while it is paused.
  void step(std::uint64_t messages);
  /// Jumps there, at most to the end.
  void seek(double position_s);
  /// @param rate  brought into kSlowestRate to kFastestRate
  void set_rate(double rate);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::record
