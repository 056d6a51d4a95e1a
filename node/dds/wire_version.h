// node/dds/wire_version.h -- which version of the messages the participants of other processes
// speak.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "node/dds/participant.h"

namespace cordis::dds {

/// Behind process_identity() in the user data of a participant.
std::string wire_version_mark(std::uint32_t version);

/// Likewise, before the wire_version_mark(): the word of a clock; empty for none.
std::string clock_mark(const std::string& clock);

/// The clock in the user data of a participant; empty when it says none.
std::string_view marked_clock(std::string_view user_data) noexcept;

/// The version in the user data of a participant. 0: it is of Cordis and older than all versions;
/// nothing: it is of another program, which is evaluated by the `wire_version` of its messages.
std::optional<std::uint32_t> marked_wire_version(std::string_view user_data) noexcept;

/// The sentence that refuses a peer.
std::string wire_version_refusal(const std::string& peer, std::uint32_t theirs, std::uint32_t ours);

/// Remembers, for all participants of this process, that a participant speaks another version than
/// msg::WIRE_VERSION.
void record_wire_version(const ParticipantPrefix& participant, std::uint32_t version);
void forget_wire_version(const ParticipantPrefix& participant) noexcept;

/// True if a participant is recorded with another version than `ours`. One that speaks
/// msg::WIRE_VERSION is never recorded. Real time: one atomic read while all do.
bool has_other_wire_version(const ParticipantPrefix& participant, std::uint32_t ours) noexcept;

}  // namespace cordis::dds
