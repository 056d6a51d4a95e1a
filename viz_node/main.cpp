// viz_node/main.cpp -- shows a session: reads DDS, serves the page. Never in the loop: kill it and
// start it again at will.
#include <chrono>
#include <cstdlib>
#include <optional>

#include <spdlog/spdlog.h>

#include "node/command_listener.h"
#include "node/dds/writer.h"
#include "node/instance_lock.h"
#include "node/node_main.h"
#include "node/random_token.h"
#include "node/status.h"
#include "node/stop.h"
#include "node/time.h"
#include "viz_node/command_relay.h"
#include "viz_node/pointer_server.h"
#include "viz_node/scene_listener.h"
#include "viz_node/scene_mirror.h"
#include "viz_node/session_topics.h"
#include "viz_node/topic_board.h"
#include "viz_node/viz_config.h"
#include "viz_node/web/server.h"
#include "viz_node/web/static_pages.h"

namespace {

using namespace cordis;

constexpr std::int64_t kFreshNsec = 1'000'000'000;

void fill(msg::NodeStatus& status, const viz::SceneMirror& mirror, const viz::WebServer& server,
          double rate_hz) {
  const viz::MirrorFigures seen = mirror.figures();
  const viz::ServerFigures shown = server.figures();
  const bool fresh =
      seen.last_frame_nsec != 0 && node::monotonic_nsec() - seen.last_frame_nsec < kFreshNsec;
  status.phase(fresh ? msg::PHASE_RUNNING : msg::PHASE_WAITING);
  if (node::stop_requested()) status.phase(msg::PHASE_STOPPED);
  status.text(server.url());
  status.target_rate_hz(seen.frame_rate_hz > 0.0 ? std::min(rate_hz, seen.frame_rate_hz) : rate_hz);
  status.ticks(seen.frames);
  status.dropped(seen.refused + seen.lost);
  status.latency_count(shown.drawn);
  status.latency_p50_s(shown.latency_p50_s);
  status.latency_p99_s(shown.latency_p99_s);
  status.latency_max_s(shown.latency_max_s);
}

void warn_about(const viz::VizConfig& config, const viz::WebServer& server) {
  if (!server.page_built())
    spdlog::warn("page not built: run `npm ci` in viz_node/web and build again");
  if (server.command_url() != server.url())
    spdlog::warn(
        "{} is open to other machines: all may see; the token in the page's address lets command",
        config.address);
}

/// What lets a page command: $CORDIS_PAGE_TOKEN, which stays the same when `cordis run` starts
/// viz_node again, else a new one.
std::string page_token() {
  const char* chosen = std::getenv("CORDIS_PAGE_TOKEN");
  return chosen != nullptr && *chosen != '\0' ? chosen : node::random_token();
}

int run(const node::NodeStart& start, config::Problems& problems) {
  const viz::VizConfig config = viz::read_viz_config(*start.node, problems);
  viz::check_address(config, problems);
  viz::check_scene_files(start.launch, config, problems);
  node::report(problems);
  if (start.check_only) return 0;

  const dds::ParticipantConfig joined = start.config();
  node::lock_instance(
      "cordis/" + std::to_string(joined.domain) + "/" + joined.session + "/" + joined.node,
      "session '" + joined.session + "' already has a node named '" + joined.node + "' in domain " +
          std::to_string(joined.domain));
  dds::Participant participant(joined);
  viz::SceneMirror mirror(config.rate_hz);
  viz::CommandRelay relay(participant, start.epoch, start.key, config.rights, start.may_command());
  std::optional<dds::Writer<msg::PointerTarget>> targets;
  if (start.may_command()) targets.emplace(participant, dds::Topic::kPointerTarget);
  viz::PointerServer pointers(start.epoch, [&targets](msg::PointerTarget& target) {
    if (targets) static_cast<void>(targets->write(target));  // the next one replaces it
  });
  std::optional<viz::TopicBoard> board;
  if (config.foxglove) board.emplace();
  viz::WebServer server({.node = joined.node,
                         .session = joined.session,
                         .address = config.address,
                         .port = config.port,
                         .folder = viz::page_folder(),
                         .token = page_token(),
                         .rights = config.rights,
                         .is_view_only = !start.may_command(),
                         .epoch = start.epoch,
                         .topics = board ? &*board : nullptr},
                        mirror, pointers,
                        [&relay](const viz::PageCommand& command) { relay.send(command); });
  std::optional<viz::SessionTopics> topics;
  if (board) topics.emplace(joined, *board);
  const viz::SceneListener listener(participant, mirror, relay, pointers);
  const node::StatusPublisher publisher(
      participant, msg::KIND_VIZ_NODE, start.epoch,
      [&](msg::NodeStatus& status) { fill(status, mirror, server, config.rate_hz); });
  node::CommandListener commands(participant, msg::KIND_VIZ_NODE, start.command_guard(),
                                 [](const msg::ControlCommand& command) {
                                   return node::nothing_to_do(command, msg::KIND_VIZ_NODE);
                                 });
  commands.start();
  if (!start.may_command()) spdlog::info("the key of this view lets no page command or drag");
  warn_about(config, server);
  spdlog::info("page at {}", server.command_url());
  if (config.foxglove)
    spdlog::info("Foxglove reads ws{}", server.url().substr(std::string_view("http").size()));
  while (!node::wait_for_stop(std::chrono::hours(1))) {
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return cordis::node::node_main(argc, argv, "viz_node", run);
}
