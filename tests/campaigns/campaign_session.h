// tests/campaigns/campaign_session.h -- the folder of one session, and what its nodes say.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "idl/control.h"
#include "node/dds/reader.h"

namespace cordis::test {

/// A folder that ends with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Writes a file. @return its path
  std::string add(const std::string& name, const std::string& text) const;
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// What the nodes say of themselves, as another process of the session receives it.
class Statuses {
 public:
  /// @param nodes  their names
  Statuses(const std::string& session, std::vector<std::string> nodes);

  /// Waits until each node has said twice more that it runs, and has done more meanwhile: steps
  /// with a hand, samples that are answered, frames that have come. @return the name of one that
  /// has not
  std::string wait_until_all_go_on(std::chrono::seconds at_most);

  const msg::NodeStatus& of(const std::string& node) { return newest_[node]; }
  dds::Participant& participant() noexcept { return participant_; }

 private:
  void take();

  std::vector<std::string> nodes_;
  dds::Participant participant_;
  dds::Reader<msg::NodeStatus> reader_;
  std::map<std::string, msg::NodeStatus> newest_;
};

}  // namespace cordis::test
