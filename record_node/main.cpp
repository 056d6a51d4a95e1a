// record_node/main.cpp -- stores a session in a file. Never in the loop: kill it and start it again
// at will.
#include <chrono>
#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "node/command_listener.h"
#include "node/instance_lock.h"
#include "node/last_take.h"
#include "node/node_main.h"
#include "node/runtime_folder.h"
#include "node/status.h"
#include "node/stop.h"
#include "record_node/mcap/writer.h"
#include "record_node/plan_report.h"
#include "record_node/record_config.h"
#include "record_node/recorder.h"

namespace {

using namespace cordis;

constexpr auto kPollPeriod = std::chrono::milliseconds(500);
constexpr double kLongSilenceS = 5.0;  // a session begins sooner

void fill(msg::NodeStatus& status, const record::Recorder& recorder, const std::string& file) {
  const record::RecorderFigures done = recorder.figures();
  status.phase(done.is_over ? msg::PHASE_FAILED : msg::PHASE_RUNNING);
  if (node::stop_requested() && !done.is_over) status.phase(msg::PHASE_STOPPED);
  status.text(done.problem.empty()
                  ? fmt::format("{}, {:.1f} MB", file, static_cast<double>(done.file_bytes) / 1e6)
                  : done.problem);
  status.ticks(done.messages);
  status.dropped(done.missed.losses());
}

/// Says so once when no topic fits, when messages begin to be dropped, and when the file takes no more.
class Watch {
 public:
  void update(const record::Recorder& recorder) {
    const record::RecorderFigures done = recorder.figures();
    if (done.seconds > kLongSilenceS && !unmatched_) {
      const std::string unmatched = recorder.unmatched();
      unmatched_ = !unmatched.empty();
      if (unmatched_) spdlog::warn("{}", unmatched);
    }
    if (done.missed.dropped > 0 && !done.is_over && !dropped_) {
      dropped_ = true;
      spdlog::warn("the disk is too slow: messages are lost, frames before gestures");
    }
    if (done.is_over && !over_) {
      over_ = true;
      spdlog::error("recording has ended: {}", done.problem);
    }
  }

 private:
  bool unmatched_ = false;
  bool dropped_ = false;
  bool over_ = false;
};

/// Closes a recorder, whatever ends the node, and says what came of it and where it is.
class Ending {
 public:
  Ending(record::Recorder& recorder, const std::filesystem::path& out)
      : recorder_(recorder), out_(out) {}
  Ending(const Ending&) = delete;
  Ending& operator=(const Ending&) = delete;
  ~Ending() { close(); }

  /// @return whether the take was recorded to its end
  bool close() {
    if (is_closed_) return is_good_;
    is_closed_ = true;
    const record::RecorderFigures done = recorder_.close();
    const std::string unmatched = recorder_.unmatched();
    const bool has_nothing = done.messages == 0 && !unmatched.empty();
    is_good_ = !done.is_over && !has_nothing;
    const std::filesystem::path file = done.has_failed ? mcap::part_of(out_) : out_;
    spdlog::info("{}: {} messages of {} that came, {:.1f} MB in {:.1f} s", file.string(),
                 done.messages - done.missed.dropped, done.messages,
                 static_cast<double>(done.file_bytes) / 1e6, done.seconds);
    if (done.missed.losses() > 0)
      spdlog::warn("{} messages lost: {} before a slow or full disk, {} on the way",
                   done.missed.losses(), done.missed.dropped,
                   done.missed.losses() - done.missed.dropped);
    if (!done.problem.empty()) spdlog::error("{}", done.problem);
    if (has_nothing) spdlog::error("nothing was recorded: {}", unmatched);
    if (done.has_failed) spdlog::error("`cordis recover {}` saves what is in it", file.string());
    return is_good_;
  }

 private:
  record::Recorder& recorder_;
  const std::filesystem::path out_;
  bool is_closed_ = false;
  bool is_good_ = false;
};

record::RecorderConfig config_of(const node::NodeStart& start,
                                 const record::RecordSection& section) {
  record::RecorderConfig config;
  config.domain = start.domain;
  config.network = start.network;
  config.security = start.config().security;
  config.session = start.launch.session;
  config.node = start.node->name;
  config.out = record::take_path(section.out, start.launch.session, start.launch.directory);
  config.topics = section.topics;
  config.excluded = section.excluded;
  config.idl = record::read_idl_files(section.idl_files, start.launch.directory);
  config.compression = section.compression;
  config.attached = record::files_of(start.launch);
  config.about = record::about_session(start.launch, config.attached);
  config.plan_command = record::plan_command(start.launch.file, record::own_overrides());
  return config;
}

/// So that a session whose take has no place does not begin.
void check_out(const node::NodeStart& start, const std::string& out, config::Problems& problems) {
  const std::string why =
      record::no_take_because(out, start.launch.session, start.launch.directory);
  if (why.empty()) return;
  const config::Value said = start.node->section.find("out");
  problems.error(said.exists() ? said.place() : start.node->place, why);
}

int run(const node::NodeStart& start, config::Problems& problems) {
  const record::RecordSection section = record::read_record_section(*start.node, problems);
  if (start.check_only) check_out(start, section.out, problems);
  node::report(problems);
  if (start.check_only) {
    record::read_idl_files(section.idl_files, start.launch.directory);
    return 0;
  }
  const dds::ParticipantConfig joined = start.config();
  node::lock_instance(
      "cordis/" + std::to_string(joined.domain) + "/" + joined.session + "/" + joined.node,
      "session '" + joined.session + "' already has a node named '" + joined.node + "' in domain " +
          std::to_string(joined.domain));
  const record::RecorderConfig config = config_of(start, section);
  for (const auto& part : record::unfinished_takes(config.out.parent_path()))
    spdlog::warn("{} was never finished: `cordis recover` saves what is in it", part.string());

  record::Recorder recorder(config);
  Ending ending(recorder, config.out);
  const std::string file = config.out.string();
  spdlog::info("records into {}", file);
  node::remember_take(node::runtime_folder(), joined.session, config.out);
  {
    dds::Participant participant(joined);
    const node::StatusPublisher publisher(
        participant, msg::KIND_RECORD_NODE, start.epoch,
        [&](msg::NodeStatus& status) { fill(status, recorder, file); });
    node::CommandListener commands(participant, msg::KIND_RECORD_NODE, start.command_guard(),
                                   [](const msg::ControlCommand& command) {
                                     return node::nothing_to_do(command, msg::KIND_RECORD_NODE);
                                   });
    commands.start();
    Watch watch;
    while (!node::wait_for_stop(kPollPeriod)) watch.update(recorder);
    ending.close();  // the last status has the last figures
  }
  return ending.close() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return cordis::node::node_main(argc, argv, "record_node", run);
}
