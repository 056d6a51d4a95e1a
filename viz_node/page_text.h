// viz_node/page_text.h -- the JSON messages of the page's protocol (viz_node/web/README.md).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/scene.h"

namespace cordis::viz {

/// What viz_node knows of one node.
struct ReportedNode {
  msg::NodeStatus status;
  std::int64_t received_nsec = 0;  ///< CLOCK_MONOTONIC when its last status came
};

/// Changes of link states, as far as a page shows them.
struct ReceivedEvents {
  std::uint64_t total = 0;  ///< since the scene was described
  std::uint64_t lost = 0;
  std::deque<msg::LinkEvent> newest;  ///< at most kEventsShown, oldest first
};
inline constexpr std::size_t kEventsShown = 12;

/// Replies to what the pages wanted, newest last.
using ReceivedReplies = std::deque<msg::ControlReply>;
inline constexpr std::size_t kRepliesShown = 4;

/// What viz_node says about its own work.
struct MirrorFigures {
  std::uint64_t frames = 0;          ///< handed to the pages
  std::uint64_t refused = 0;         ///< messages that did not fit their description
  std::uint64_t lost = 0;            ///< frames of sim_node that never came
  double frame_rate_hz = 0.0;        ///< rate from the description; 0 without one
  std::int64_t last_frame_nsec = 0;  ///< CLOCK_MONOTONIC when the newest came; 0: none yet
};

/// A node that was silent for so long is lost, unless it said that it stops.
inline constexpr std::int64_t kLostAfterNsec = 1'600'000'000;

/// What the launch file lets pages do beyond the commands that change no scene.
struct PageRights {
  std::vector<std::string> scenes;  ///< scenes that they may load, relative to the launch file
  bool parameters = false;          ///< they may set parameters
};

/// @param may_command  whether viz_node takes commands and a hand of the page
std::string hello_text(const std::string& session, const std::string& node,
                       const PageRights& rights, bool may_command);
std::string description_text(const msg::SceneDescription& description, std::uint32_t scene);
std::string status_text(const std::vector<ReportedNode>& nodes,
                        const std::vector<msg::DeviceDescription>& devices,
                        const ReceivedEvents& events, const ReceivedReplies& replies,
                        const MirrorFigures& figures, std::uint32_t scene, std::int64_t now_nsec);

/// A page's word that it is done with all frames up to `sequence`; `drawn` when it has drawn that
/// one.
struct Acknowledgement {
  std::uint32_t sequence = 0;
  bool drawn = false;
};

/// Reads `{"type": "ack", "sequence": 12, "drawn": true}`; nothing when `text` is anything else.
std::optional<Acknowledgement> read_acknowledgement(std::string_view text);

/// Reads `{"type": "sound", "on": true}`: whether the page listens; nothing when `text` is anything
/// else.
std::optional<bool> read_sound_request(std::string_view text);

/// What a page wants of the simulation.
struct PageCommand {
  msg::ControlVerb verb = msg::VERB_PAUSE;  ///< or resume, step, reset, get, set, load, seek, rate
  std::uint64_t steps = 1;                  ///< for `step`
  double value = 0.0;       ///< for `seek`: the time in the take [s]; for `rate`; for `set`
  std::string parameter;    ///< for `set`: NAME.PARAMETER
  std::uint64_t scene = 0;  ///< for `load`: which of the scenes that pages may load
};

/// Reads `{"type": "command", "verb": "step", "steps": 10}`, or `"verb": "seek", "value": 2.5`; nothing when `text` is anything else,
/// or wants what a page may not: it names no files.
std::optional<PageCommand> read_page_command(std::string_view text);

/// The argument of control/command that says the same. A name is quoted: it stays one name.
/// Nothing when the page has no right to it.
std::optional<std::string> argument_of(const PageCommand& command, const PageRights& rights);

}  // namespace cordis::viz
