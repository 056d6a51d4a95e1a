// cli/play/play_verb.cpp
#include "cli/play/play_verb.h"

#include <charconv>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/play/play_keys.h"
#include "cli/progress_line.h"
#include "cli/take_file.h"
#include "node/config/launch.h"
#include "node/log.h"
#include "node/runtime_folder.h"
#include "node/security/identity.h"
#include "node/security/keyring.h"
#include "node/session_key.h"
#include "node/session_registry.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/reader.h"
#include "record_node/take_player.h"

namespace cordis::cli {
namespace {

constexpr auto kPlayProgress = std::chrono::milliseconds(100);

struct PlayWords {
  std::string take;
  std::string rate = "1";
  std::string start_offset;
  std::string duration;
  std::string session;
  std::string domain;
  std::string keyring;
  std::vector<std::string> topics;
  std::vector<std::string> excluded;
  std::vector<std::string> remapped;
  bool loop = false;
  bool paused = false;
  bool waits = false;
};

double rate_in(const std::string& text) {
  double rate = 0.0;
  const auto [after, fault] = std::from_chars(text.data(), text.data() + text.size(), rate);
  if (fault != std::errc() || after != text.data() + text.size() ||
      !(rate >= record::kSlowestRate && rate <= record::kFastestRate))
    throw UsageError(fmt::format("--rate must be a number above 0, from {:g} to {:g}, got '{}'",
                                 record::kSlowestRate, record::kFastestRate, text));
  return rate;
}

/// The session that the take says it is of.
std::string session_of(const mcap::Reader& take) {
  for (const mcap::Metadata& words : take.metadata()) {
    const auto session = words.values.find("session");
    if (words.name == "cordis.session" && session != words.values.end() && !session->second.empty())
      return session->second;
  }
  return "played";
}

std::map<std::string, std::string> remapped_in(const std::vector<std::string>& words) {
  std::map<std::string, std::string> names;
  for (const std::string& word : words) {
    const std::size_t middle = word.find(":=");
    if (middle == std::string::npos || middle == 0 || middle + 2 == word.size())
      throw UsageError("'" + word + "' is not of the form TOPIC:=OTHER");
    names[word.substr(0, middle)] = word.substr(middle + 2);
  }
  return names;
}

std::string absolute_folder(const std::string& folder) {
  return std::filesystem::absolute(folder).lexically_normal().string();
}

/// The key of the player. Its folder has the key of commands too, unless the user has chosen one.
dds::Security security_of_player(const std::string& keyring) {
  if (keyring.empty()) return {};
  const node::Identity identity = node::identity_in(keyring, {node::Role::kPlayer}, "");
  if (identity.role != node::Role::kPlayer)
    throw std::runtime_error("the key in " + keyring + " is for the role " +
                             node::role_word(identity.role) +
                             ", which plays no take: `cordis keys add` makes one for a player");
  setenv("CORDIS_SESSION_KEY_FILE", node::SharedKeyFiles(keyring).command_key.c_str(),
         /*replace=*/0);
  return identity.security;
}

/// Its name and domain as the user wants them. @throws UsageError for a domain that is none
node::SessionRequest request_of(const PlayWords& words, const std::string& session) {
  std::optional<int> domain;
  if (!words.domain.empty()) {
    int number = -1;
    const auto [after, fault] =
        std::from_chars(words.domain.data(), words.domain.data() + words.domain.size(), number);
    if (fault != std::errc() || after != words.domain.data() + words.domain.size() || number < 0 ||
        number > config::kHighestDomain)
      throw UsageError("--domain must be 0 to 101, got '" + words.domain + "'");
    domain = number;
  }
  return {.session = session,
          .domain = domain,
          .launch_file = std::filesystem::absolute(words.take).string(),
          .nodes = {"play"},
          .is_player = true,
          .keyring = words.keyring.empty() ? "" : absolute_folder(words.keyring),
          .has_key = true};
}

void execute(PlayKey key, record::TakePlayer& player) {
  const record::TakePlayerFigures now = player.figures();
  switch (key) {
    case PlayKey::kSpace:
      return player.pause(!now.paused);
    case PlayKey::kRight:
      return player.step(1);
    case PlayKey::kUp:
      return player.set_rate(now.rate * 1.1);
    case PlayKey::kDown:
      return player.set_rate(now.rate / 1.1);
    case PlayKey::kNone:
      return;
  }
}

int play_into(const node::SessionRegistration& registration, record::TakePlayerConfig config) {
  config.domain = registration.domain();
  config.key = node::key_of_session(config.session, config.domain);
  record::TakePlayer player(config);
  if (!player.damage().empty()) node::print_text(stderr, "cordis play: " + player.damage() + "\n");
  std::fprintf(stderr, "session '%s' in DDS domain %d%s; Ctrl-C ends it\n", config.session.c_str(),
               config.domain, config.security.is_on() ? ", secured" : "");
  PlayKeys keys;
  ProgressLine line;
  record::TakePlayerFigures now = player.figures();
  while (!node::wait_for_stop(kPlayProgress)) {
    for (PlayKey key = keys.next(); key != PlayKey::kNone; key = keys.next()) execute(key, player);
    now = player.figures();
    line.show(fmt::format("{:.1f} of {:.1f} s  rate {:.3g}  {} messages{}", now.position_s,
                          now.length_s, now.rate, now.messages, now.paused ? "  paused" : ""));
    if (now.is_over && !now.paused) break;
  }
  line.end();
  now = player.figures();
  std::printf("%llu messages played\n", static_cast<unsigned long long>(now.messages));
  if (now.failed > 0)
    std::fprintf(stderr, "cordis play: DDS did not take %llu messages\n",
                 static_cast<unsigned long long>(now.failed));
  return now.failed > 0 || !player.damage().empty() ? kLoss : kSuccess;
}

int play(const PlayWords& words) {
  record::TakePlayerConfig config;
  config.take = words.take;
  config.rate = rate_in(words.rate);
  config.loop = words.loop;
  config.paused = words.paused;
  config.waits_for_readers = words.waits;
  config.topics = words.topics;
  config.excluded = words.excluded;
  config.remapped = remapped_in(words.remapped);
  if (!words.duration.empty()) config.duration_s = seconds_of(parse_offset(words.duration));
  try {
    const mcap::Reader take(config.take);
    config.session = words.session.empty() ? session_of(take) : words.session;
    if (!words.start_offset.empty())
      config.start_s = 1e-9 * static_cast<double>(start_offset_in(take, words.start_offset));
  } catch (const mcap::FileError& error) {
    node::print_text(stderr, std::string("cordis play: ") + error.what() + "\n");
    return kBadInput;
  }
  config.security = security_of_player(words.keyring);
  node::install_log("play");
  node::install_stop_signals();
  std::optional<node::SessionRegistration> registration;
  try {
    registration.emplace(node::runtime_folder(), request_of(words, config.session));
  } catch (const node::SessionRuns& error) {
    std::fprintf(stderr, "cordis play: %s: give the played one another name with --session NAME\n",
                 error.what());
    return kBadInput;
  }
  return play_into(*registration, std::move(config));
}

}  // namespace

void add_play_verb(CommandLine& line) {
  auto words = std::make_shared<PlayWords>();
  Verb& verb = line.verb("play", "TAKE [options]", "Publish a take on DDS, as its session did");
  verb.required_word("TAKE", words->take, "A take: an MCAP file");
  verb.option("-r,--rate", "RATE", words->rate,
              "Times as fast as it was recorded, 0.001 to 1000 (1)");
  verb.flag("-l,--loop", words->loop, "Begin again at the end");
  verb.flag("-p,--start-paused", words->paused, "Wait for the space key, or `ctl resume`");
  verb.option("--start-offset", "TIME", words->start_offset, "Begin so far into the take");
  verb.option("--playback-duration", "TIME", words->duration, "End after so much of the take");
  verb.list("--topics", "GLOB,...", words->topics, "These topics alone; else all but control/*");
  verb.list("--exclude", "GLOB,...", words->excluded, "Not these topics");
  verb.list("-m,--remap", "A:=B,...", words->remapped, "Play topic A under the name B");
  verb.flag("--wait-for-readers", words->waits, "Begin when each topic has a reader");
  verb.option("--session", "NAME", words->session, "Name of the session (that of the take)");
  verb.option("--domain", "N", words->domain, "DDS domain (a free one)");
  verb.option("--security", "FOLDER", words->keyring,
              "Keys: the session is secured, and all that join it need keys");
  verb.examples(
      "It never joins a session that runs: the recorded hand would move its scene. Nor does a\n"
      "sim_node or device_node join it; viewers and recorders do.\n"
      "Keys: space pauses and goes on, right plays one message, up and down change the rate by\n"
      "10 %. `cordis ctl SESSION pause|resume|seek|rate|reset` does so from elsewhere.\n"
      "The payloads stay as they are; topics of late joiners are kept for them, after a jump too.\n"
      "The status of viewers and recorders is not played.\n"
      "Exit code: 0 done, 1 failed, 2 no take or bad command line, 3 done with loss.\n\n"
      "Examples:\n"
      "  cordis play take.mcap\n"
      "  cordis play take.mcap --rate 0.25 --start-offset 10s --loop\n"
      "  cordis play take.mcap --session copy --topics 'scene/*'\n");
  verb.action([words] { return play(*words); });
}

}  // namespace cordis::cli
