// node/session_registry.cpp
#include "node/session_registry.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <unistd.h>

#include "node/config/launch.h"
#include "node/dds/process_identity.h"
#include "node/domain_lock.h"
#include "node/runtime_folder.h"
#include "node/session_key.h"
#include "node/session_network.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

// A file of a session is SESSION.DOMAIN.session, and says in lines of a word and its value what
// else is known of it. A line with another word is passed over.
constexpr const char* kSuffix = ".session";

fs::path file_of(const fs::path& folder, const std::string& session, int domain) {
  return folder / (session + "." + std::to_string(domain) + kSuffix);
}

bool is_alive(const SessionMember& member) {
  return dds::state_of(member.identity) == dds::ProcessState::kAlive;
}

SessionMember read_member(std::istream& words) {
  SessionMember member;
  words >> member.process;
  for (std::string node; words >> node;) member.nodes.push_back(std::move(node));
  return member;
}

/// @return what a file says, with the members that live; none when it is not to be understood.
SessionRecord read_record(const fs::path& path) {
  SessionRecord record;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word >> std::ws;
    if (word == "session") words >> record.session;
    if (word == "domain") words >> record.domain;
    if (word == "launch_file") std::getline(words, record.launch_file);
    if (word == "keyring") std::getline(words, record.keyring);
    if (word == "network") {
      std::string network;
      std::getline(words, network);
      record.network = network_of_line(network);
    }
    if (word == "member") record.members.push_back(read_member(words));
    if (word == "player" && !record.members.empty()) record.members.back().is_player = true;
    if (word == "identity" && !record.members.empty())
      std::getline(words, record.members.back().identity);
  }
  std::erase_if(record.members, [](const SessionMember& member) { return !is_alive(member); });
  return record;
}

/// Removes the file of a session and that of its key.
void remove_files(fs::path file) {
  fs::remove(file);
  fs::remove(file.replace_extension(".key"));
}

/// Gives a session its key. The lock of the folder must be held.
/// @param is_new  no process of it lives
void make_key(const fs::path& folder, const SessionRecord& record, bool is_new) {
  const fs::path registered = registered_key_file(folder, record.session, record.domain);
  const fs::path chosen = chosen_key_file();
  const bool has_key = !is_new && fs::exists(registered);
  if (has_key && chosen.empty()) return;
  const SessionKey key = chosen.empty() ? SessionKey::random() : read_key_file(chosen);
  if (!has_key) return write_key_file(registered, key);
  if (read_key_file(registered) == key) return;
  throw std::runtime_error("session '" + record.session + "' of domain " +
                           std::to_string(record.domain) + " runs with another key than that of " +
                           chosen.string());
}

/// Replaces the file at once: whoever reads it sees the old text or the new.
void write_record(const fs::path& folder, const SessionRecord& record) {
  std::string launch_file = record.launch_file;
  std::replace(launch_file.begin(), launch_file.end(), '\n', '?');
  if (record.keyring.find('\n') != std::string::npos)
    throw std::runtime_error("the path of a folder of keys is one line: " + record.keyring);
  const fs::path draft = folder / "draft";
  std::ofstream file(draft, std::ios::trunc);
  file << "session " << record.session << "\ndomain " << record.domain << "\nlaunch_file "
       << launch_file << '\n';
  if (!record.network.is_loopback()) file << "network " << network_line(record.network) << '\n';
  if (!record.keyring.empty()) file << "keyring " << record.keyring << '\n';
  for (const SessionMember& member : record.members) {
    file << "member " << member.process;
    for (const std::string& node : member.nodes) file << ' ' << node;
    file << "\nidentity " << member.identity << (member.is_player ? "\nplayer\n" : "\n");
  }
  file.close();
  if (!file) throw std::runtime_error("cannot write " + draft.string());
  fs::rename(draft, file_of(folder, record.session, record.domain));
}

/// The lock of the folder must be held.
std::vector<SessionRecord> read_records(const fs::path& folder) {
  std::vector<SessionRecord> records;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != kSuffix) continue;
    SessionRecord record = read_record(entry.path());
    if (record.members.empty()) {
      remove_files(entry.path());
    } else {
      records.push_back(std::move(record));
    }
  }
  std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
    return std::pair(a.session, a.domain) < std::pair(b.session, b.domain);
  });
  return records;
}

struct HeldDomain {
  int domain;
  int file;  // holds it
};

/// Domain 0 comes last: other DDS programs use it unless they are set otherwise.
HeldDomain lock_free_domain(const std::vector<SessionRecord>& records) {
  std::set<int> taken;
  for (const SessionRecord& record : records) taken.insert(record.domain);
  for (int i = 1; i <= config::kHighestDomain + 1; ++i) {
    const int domain = i % (config::kHighestDomain + 1);
    if (taken.contains(domain)) continue;
    const int file = lock_domain(domain);
    if (file >= 0) return {domain, file};
  }
  throw std::runtime_error(
      "no DDS domain of 0..101 is free on this host: end a session, or name one with domain=N");
}

std::vector<SessionRecord> of_name(const std::vector<SessionRecord>& records,
                                   const std::string& session) {
  std::vector<SessionRecord> same;
  std::copy_if(records.begin(), records.end(), std::back_inserter(same),
               [&](const SessionRecord& record) { return record.session == session; });
  return same;
}

bool is_alive_still(const SessionRecord& record) {
  return std::any_of(record.members.begin(), record.members.end(), is_alive);
}

HeldDomain domain_for(const SessionRequest& request, const std::vector<SessionRecord>& records) {
  if (request.domain) return {*request.domain, join_domain(*request.domain, [] { return true; })};
  const std::vector<SessionRecord> same = of_name(records, request.session);
  if (same.size() > 1)
    throw std::runtime_error("session '" + request.session + "' runs in " + domains_text(same) +
                             ": name one of them with domain=N, or give this one session=NAME");
  if (!same.empty()) {
    // When its last process dies now, another user may have its domain a moment later.
    const int file = join_domain(same[0].domain, [&] { return is_alive_still(same[0]); });
    if (file >= 0) return {same[0].domain, file};
  }
  return lock_free_domain(records);
}

/// A session that is to be new must not reach the nodes of one that runs.
void refuse_running(const SessionRequest& request, const std::vector<SessionRecord>& records) {
  std::vector<SessionRecord> same = of_name(records, request.session);
  if (request.domain)
    std::erase_if(same,
                  [&](const SessionRecord& found) { return found.domain != *request.domain; });
  if (!same.empty())
    throw SessionRuns("session '" + request.session + "' runs in DDS " + domains_text(same));
}

void refuse_same_nodes(const SessionRecord& record, const std::vector<std::string>& nodes) {
  for (const SessionMember& member : record.members) {
    for (const std::string& node : nodes) {
      if (std::find(member.nodes.begin(), member.nodes.end(), node) == member.nodes.end()) continue;
      throw std::runtime_error("session '" + record.session + "' already runs in DDS domain " +
                               std::to_string(record.domain) + " with a node named '" + node +
                               "' (process " + std::to_string(member.process) +
                               "); stop it, or give this one session=NAME");
    }
  }
}

/// The hand and the scene of a take would meet those of the nodes.
void refuse_beside_a_player(const SessionRecord& record) {
  const auto player = std::find_if(record.members.begin(), record.members.end(),
                                   [](const SessionMember& member) { return member.is_player; });
  if (player == record.members.end()) return;
  throw std::runtime_error("session '" + record.session + "' in DDS domain " +
                           std::to_string(record.domain) + " is a take that is played (process " +
                           std::to_string(player->process) +
                           "); stop it, or give this one session=NAME");
}

/// Processes with other addresses would not find each other.
void refuse_other_network(const SessionRecord& record, const dds::Network& network) {
  if (record.network.address == network.address) return;
  throw std::runtime_error("session '" + record.session + "' runs in DDS domain " +
                           std::to_string(record.domain) + " on " + record.network.address +
                           " of this host, and this part of it would be on " + network.address +
                           ": give all parts the same network");
}

/// Processes with keys and processes without do not receive each other.
void refuse_other_security(const SessionRecord& record, const std::string& keyring) {
  if (record.keyring.empty() == keyring.empty()) return;
  const std::string where =
      "session '" + record.session + "' runs in DDS domain " + std::to_string(record.domain);
  throw std::runtime_error(keyring.empty()
                               ? where + " with the keys of " + record.keyring +
                                     ", and this part of it has none: give it the same `security`"
                               : where + " without keys, and this part of it has those of " +
                                     keyring + ": give all parts the same `security`");
}

}  // namespace

std::vector<SessionRecord> running_sessions(const fs::path& folder) {
  const FolderLock lock(folder);
  return read_records(folder);
}

int domain_of_next_session(const fs::path& folder) {
  const FolderLock lock(folder);
  const HeldDomain held = lock_free_domain(read_records(folder));
  close(held.file);
  return held.domain;
}

std::string domains_text(const std::vector<SessionRecord>& sessions) {
  std::string text = sessions.size() == 1 ? "domain " : "domains ";
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    if (i > 0) text += i + 1 == sessions.size() ? " and " : ", ";
    text += std::to_string(sessions[i].domain);
  }
  return text;
}

SessionRegistration::SessionRegistration(fs::path folder, const SessionRequest& request)
    : folder_(std::move(folder)), session_(request.session) {
  const FolderLock lock(folder_);
  const std::vector<SessionRecord> records = read_records(folder_);
  if (request.is_player) refuse_running(request, records);
  const auto [domain, held] = domain_for(request, records);
  domain_ = domain;
  lock_ = held;
  SessionRecord record{session_, domain_,         request.launch_file,
                       {},       request.network, request.keyring};
  for (const SessionRecord& other : records) {
    if (other.session == session_ && other.domain == domain_) record = other;
  }
  try {
    if (request.simulates) refuse_beside_a_player(record);
    refuse_same_nodes(record, request.nodes);
    refuse_other_network(record, request.network);
    refuse_other_security(record, request.keyring);
    if (request.has_key) make_key(folder_, record, record.members.empty());
    record.members.push_back({getpid(), dds::process_identity(), request.nodes, request.is_player});
    write_record(folder_, record);
  } catch (...) {
    if (lock_ >= 0) close(lock_);
    throw;
  }
}

SessionRegistration::~SessionRegistration() {
  change_own_member([](SessionMember& member) { member.process = 0; });
  if (lock_ >= 0) close(lock_);
}

void SessionRegistration::remove_node(const std::string& node) noexcept {
  change_own_member([&](SessionMember& member) { std::erase(member.nodes, node); });
}

/// A member without a process is removed, and so is the file of a session without members. What
/// cannot be written now is removed by whoever reads the registry when this process is dead.
void SessionRegistration::change_own_member(
    const std::function<void(SessionMember&)>& change) const noexcept {
  try {
    const FolderLock lock(folder_, std::chrono::milliseconds(500));
    for (SessionRecord& record : read_records(folder_)) {
      if (record.session != session_ || record.domain != domain_) continue;
      for (SessionMember& member : record.members) {
        if (member.process == getpid()) change(member);
      }
      std::erase_if(record.members,
                    [](const SessionMember& member) { return member.process == 0; });
      if (record.members.empty()) {
        remove_files(file_of(folder_, session_, domain_));
      } else {
        write_record(folder_, record);
      }
    }
  } catch (const std::exception&) {
    return;
  }
}

}  // namespace cordis::node
