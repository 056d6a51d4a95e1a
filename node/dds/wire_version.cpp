// node/dds/wire_version.cpp
#include "node/dds/wire_version.h"

#include <atomic>
#include <charconv>
#include <map>
#include <mutex>

namespace cordis::dds {
namespace {

constexpr std::string_view kMark = " wire ";
constexpr std::string_view kClockMark = " clock ";

/// Participants that speak another version, of which there are none as a rule.
struct OtherVersions {
  std::mutex mutex;
  std::map<ParticipantPrefix, std::uint32_t> versions;
  std::atomic<bool> any{false};
};

/// Shared by all participants of the process, each of which discovers a peer by itself.
OtherVersions& other_versions() {
  static OtherVersions others;
  return others;
}

}  // namespace

std::string wire_version_mark(std::uint32_t version) {
  return std::string(kMark) + std::to_string(version);
}

std::string clock_mark(const std::string& clock) {
  return clock.empty() ? "" : std::string(kClockMark) + clock;
}

std::string_view marked_clock(std::string_view user_data) noexcept {
  const std::size_t mark = user_data.rfind(kClockMark);
  if (!user_data.starts_with("process ") || mark == std::string_view::npos) return {};
  const std::string_view rest = user_data.substr(mark + kClockMark.size());
  return rest.substr(0, rest.find(' '));
}

std::optional<std::uint32_t> marked_wire_version(std::string_view user_data) noexcept {
  if (!user_data.starts_with("process ")) return std::nullopt;
  const std::size_t mark = user_data.rfind(kMark);
  std::uint32_t version = 0;
  if (mark != std::string_view::npos) {
    const char* const begin = user_data.data() + mark + kMark.size();
    std::from_chars(begin, user_data.data() + user_data.size(), version);
  }
  return version;
}

std::string wire_version_refusal(const std::string& peer, std::uint32_t theirs,
                                 std::uint32_t ours) {
  const std::string version = theirs == 0 ? "no version" : "version " + std::to_string(theirs);
  return "'" + peer + "' speaks " + version + " of the wire and this process version " +
         std::to_string(ours) + ": its messages are refused, and no force flows; " +
         "start all nodes of a session from the same Cordis";
}

void record_wire_version(const ParticipantPrefix& participant, std::uint32_t version) {
  if (version == msg::WIRE_VERSION) return;
  OtherVersions& others = other_versions();
  const std::lock_guard lock(others.mutex);
  others.versions[participant] = version;
  others.any = true;
}

void forget_wire_version(const ParticipantPrefix& participant) noexcept {
  OtherVersions& others = other_versions();
  if (!others.any) return;
  const std::lock_guard lock(others.mutex);
  others.versions.erase(participant);
  others.any = !others.versions.empty();
}

bool has_other_wire_version(const ParticipantPrefix& participant, std::uint32_t ours) noexcept {
  OtherVersions& others = other_versions();
  if (!others.any) return false;
  const std::lock_guard lock(others.mutex);
  const auto known = others.versions.find(participant);
  return known != others.versions.end() && known->second != ours;
}

}  // namespace cordis::dds
