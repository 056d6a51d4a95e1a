// record_node/take_player.cpp
#include "record_node/take_player.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "idl/control.h"
#include "idl/topics.h"
#include "node/command_listener.h"
#include "node/control_verbs.h"
#include "node/dds/participant.h"
#include "node/dds/raw_writer.h"
#include "node/dds/topics.h"
#include "node/status.h"
#include "node/time.h"
#include "record_node/idl/idl_parser.h"
#include "record_node/idl/message_decoder.h"
#include "record_node/last_messages.h"
#include "record_node/mcap/reader.h"
#include "record_node/mcap/topic_glob.h"
#include "record_node/topic_words.h"

namespace cordis::record {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kLongestWait = std::chrono::milliseconds(100);
constexpr auto kLongestForReaders = std::chrono::seconds(60);
constexpr auto kReadersSettle = std::chrono::milliseconds(200);
constexpr const char* kName = "play";
constexpr double kMaxSteps = 1e6;
// Every node speaks again within this time: so far before a jump lies the last status of each.
constexpr double kStatusSearchS = 2.0;

std::span<const std::uint8_t> bytes_of(const mcap::Message& message) {
  return {reinterpret_cast<const std::uint8_t*>(message.data.data()), message.data.size()};
}

/// Looks for the kind of a node in its status.
class KindSink final : public FieldSink {
 public:
  std::int64_t kind = -1;

  void begin_struct() override {}
  void member(std::string_view name) override { is_kind_ = name == "kind"; }
  void end_struct() override {}
  void begin_list(std::size_t) override {}
  void end_list() override {}
  void truth(bool) override {}
  void integer(std::int64_t) override {}
  void natural(std::uint64_t) override {}
  void real(double, bool) override {}
  void text(std::string_view) override {}
  void word(std::string_view, std::int64_t value) override {
    if (is_kind_) kind = value;
  }

 private:
  bool is_kind_ = false;
};

/// True if a viewer, a recorder or another player said it: those of the take are not here.
bool is_of_bystander(const MessageType& status, const mcap::Message& message) {
  KindSink sink;
  try {
    decode(status, bytes_of(message), sink);
  } catch (const DecodeError&) {
    return false;
  }
  return sink.kind >= msg::KIND_VIZ_NODE;
}

/// The type of a channel as the take describes it: members of an older one stand at other places
/// than those of today. Null when the take has none that is understood.
MessageTypePtr type_of(const mcap::Schema* schema) {
  if (schema == nullptr || schema->encoding != "omgidl") return nullptr;
  try {
    const MessageTypes types = parse_idl(schema->data, schema->name);
    const auto found = types.find(schema->name);
    return found == types.end() ? nullptr : found->second;
  } catch (const IdlError&) {
    return nullptr;
  }
}

std::optional<double> number_in(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [after, fault] = std::from_chars(text.data(), end, number);
  if (fault != std::errc() || after != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// The version of the wire that the take was recorded with; that of this program when it says none.
std::uint32_t wire_version_of(const mcap::Reader& take) {
  for (const mcap::Metadata& words : take.metadata()) {
    const auto version = words.values.find("wire_version");
    if (words.name != "cordis.session" || version == words.values.end()) continue;
    return static_cast<std::uint32_t>(std::strtoul(version->second.c_str(), nullptr, 10));
  }
  return msg::WIRE_VERSION;
}

/// True if the take was recorded in a session with hot standbys: its gesture topics have owners.
bool has_standbys(const mcap::Reader& take) {
  return std::ranges::any_of(take.channels(), [](const auto& numbered) {
    const mcap::Channel& channel = numbered.second;
    return topic_of(channel.topic, "", channel.metadata).exclusive;
  });
}

dds::ParticipantConfig member_of(const TakePlayerConfig& config, const mcap::Reader& take,
                                 const std::string& name) {
  dds::ParticipantConfig member{config.domain, config.session, name};
  member.wire_version = wire_version_of(take);
  member.standbys = has_standbys(take);
  member.security = config.security;
  return member;
}

}  // namespace

struct TakePlayer::Impl {
  explicit Impl(TakePlayerConfig wanted)
      : config(std::move(wanted)),
        take(config.take),
        rate(std::clamp(config.rate, kSlowestRate, kFastestRate)),
        paused(config.paused),
        topics(member_of(config, take, std::string(kName) + "/topics")),
        participant(member_of(config, take, kName)) {
    make_writers();
    const mcap::Statistics& all = take.statistics();
    first_nsec = all.start_nsec;
    length_nsec = all.end_nsec - all.start_nsec;
    begin_nsec = offset_of(config.start_s);
    if (config.start_s > static_cast<double>(length_nsec) * 1e-9)
      throw std::runtime_error(fmt::format(
          "{} ends after {:.3f} s: nothing is to play from {:g} s on", config.take.string(),
          static_cast<double>(length_nsec) * 1e-9, config.start_s));
    end_nsec = config.duration_s ? std::min(length_nsec, begin_nsec + offset_of(*config.duration_s))
                                 : length_nsec;
    if (config.loop && end_nsec <= begin_nsec)
      throw std::runtime_error(config.take.string() +
                               ": what is to be played again and again has no length");
    jump_to = begin_nsec;
    const auto epoch = static_cast<std::uint64_t>(node::monotonic_nsec());
    status.emplace(participant, msg::KIND_PLAYER, epoch,
                   [this](msg::NodeStatus& said) { fill(said); });
    commands.emplace(participant, msg::KIND_SIM_NODE,
                     node::CommandGuard(config.key, config.session, {kName, epoch}),
                     [this](const msg::ControlCommand& command) { return execute(command); });
    commands->start();
    thread = std::thread([this] { play(); });
  }

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      ending = true;
    }
    changed.notify_one();
    thread.join();
    for (auto& [topic, writer] : writers) {
      if (topic.reliable) writer->finish();
    }
  }

  const TakePlayerConfig config;
  const mcap::Reader take;
  std::uint64_t first_nsec = 0;   // log time of the first message
  std::uint64_t length_nsec = 0;  // the rest count from there
  std::uint64_t begin_nsec = 0;
  std::uint64_t end_nsec = 0;

  mutable std::mutex mutex;  // of all up to `ending`
  std::condition_variable changed;
  double rate;
  bool paused;
  bool over = false;
  std::optional<std::uint64_t> jump_to;
  std::uint64_t steps = 0;
  std::uint64_t position_nsec = 0;  // at `since`
  Clock::time_point since = Clock::now();
  std::uint64_t messages = 0;
  std::uint64_t failed = 0;
  bool ending = false;

  dds::Participant topics;
  dds::Participant participant;  // of status and commands
  std::map<dds::RawTopic, std::unique_ptr<dds::RawWriter>> writers;
  std::map<std::uint16_t, dds::RawWriter*> writer_of;   // a channel
  std::map<std::uint16_t, MessageTypePtr> status_type;  // of each channel of statuses; no null
  std::vector<std::string> played;                      // names of topics in the take
  std::vector<std::string> kept;                        // those that late joiners get
  std::optional<node::StatusPublisher> status;
  std::optional<node::CommandListener> commands;
  std::thread thread;

  std::uint64_t offset_of(double seconds) const {
    const double nsec = std::clamp(seconds, 0.0, 1e9) * 1e9;
    return std::min(static_cast<std::uint64_t>(std::llround(nsec)), length_nsec);
  }

  bool is_wanted(const std::string& topic) const {
    if (!config.excluded.empty() && mcap::matches_topic(topic, config.excluded)) return false;
    // What was said to the nodes then is not to be said to those of now.
    if (config.topics.empty()) return !topic.starts_with("control/");
    return mcap::matches_topic(topic, config.topics);
  }

  void make_writers() {
    for (const auto& [id, channel] : take.channels()) {
      if (channel.message_encoding != "cdr" || !is_wanted(channel.topic)) continue;
      const mcap::Schema* schema = take.schema_of(channel);
      dds::RawTopic topic =
          topic_of(channel.topic, schema == nullptr ? "" : schema->name, channel.metadata);
      if (topic.type.empty()) continue;
      if (const auto other = config.remapped.find(topic.name); other != config.remapped.end())
        topic.name = other->second;
      auto& writer = writers[topic];
      if (writer == nullptr) writer = std::make_unique<dds::RawWriter>(topics, topic);
      writer_of[id] = writer.get();
      if (channel.topic == msg::TOPIC_STATUS) {
        if (MessageTypePtr type = type_of(schema)) status_type[id] = std::move(type);
      }
      played.push_back(channel.topic);
      if (topic.transient_local) kept.push_back(channel.topic);
    }
    for (const auto& [name, other] : config.remapped) {
      if (std::ranges::find(played, name) == played.end())
        throw std::runtime_error(config.take.string() + " plays no topic '" + name +
                                 "' that could be called '" + other + "'");
    }
    if (writers.empty())
      throw std::runtime_error(config.take.string() + " has nothing to play" +
                               (config.topics.empty() ? "" : ": no topic fits"));
  }

  /// Where it is; the lock is held.
  std::uint64_t position_now() const {
    if (paused || over) return position_nsec;
    const double run =
        std::chrono::duration<double, std::nano>(Clock::now() - since).count() * rate;
    return std::min(end_nsec, position_nsec + static_cast<std::uint64_t>(std::max(0.0, run)));
  }
  /// Counts from here on with another rate or state; the lock is held.
  void rebase() {
    position_nsec = position_now();
    since = Clock::now();
  }

  TakePlayerFigures figures() const {
    const std::lock_guard lock(mutex);
    return {.position_s = static_cast<double>(jump_to.value_or(position_now())) * 1e-9,
            .length_s = static_cast<double>(length_nsec) * 1e-9,
            .rate = rate,
            .paused = paused,
            .is_over = over,
            .messages = messages,
            .failed = failed};
  }

  void fill(msg::NodeStatus& said) const {
    const TakePlayerFigures now = figures();
    said.phase(now.paused ? msg::PHASE_PAUSED : msg::PHASE_RUNNING);
    if (now.is_over && !now.paused) said.phase(msg::PHASE_STOPPED);
    said.text(fmt::format("{:.3f} of {:.3f} s, rate {:g}, {}", now.position_s, now.length_s,
                          now.rate, config.take.filename().string()));
    said.ticks(now.messages);
    said.dropped(now.failed);
  }

  /// A reader of another program may know of its writer a little later than the writer of it: what
  /// is sent before, it never receives.
  void wait_for_readers() {
    const auto limit = Clock::now() + kLongestForReaders;
    std::unique_lock lock(mutex);
    while (!ending && Clock::now() < limit) {
      const bool all = std::ranges::all_of(
          writers, [](const auto& writer) { return writer.second->matched_count() > 0; });
      if (all) {
        changed.wait_for(lock, kReadersSettle, [this] { return ending; });
        return;
      }
      changed.wait_for(lock, std::chrono::milliseconds(10));
    }
    if (!ending) spdlog::warn("not every topic has a reader after 60 s; it begins all the same");
  }

  mcap::MessageCursor cursor_at(std::uint64_t offset_nsec) const {
    return take.messages({.topics = played,
                          .start_nsec = first_nsec + offset_nsec,
                          .end_nsec = first_nsec + end_nsec});
  }

  void send(const mcap::Message& message) {
    const auto writer = writer_of.find(message.channel_id);
    if (writer == writer_of.end()) return;
    const auto type = status_type.find(message.channel_id);
    if (type != status_type.end() && is_of_bystander(*type->second, message)) return;
    const std::span<const std::uint8_t> bytes = bytes_of(message);
    buffer.assign(bytes.begin(), bytes.end());
    const bool sent = writer->second->write(buffer);
    const std::lock_guard lock(mutex);
    ++messages;
    if (!sent) ++failed;
  }
  std::vector<std::uint8_t> buffer;

  /// Publishes what a late joiner would find at this time: the last message of each kept topic and
  /// key, and as many of scene/inputs as the sim_node keeps.
  void restore(std::uint64_t offset_nsec) {
    if (kept.empty() || offset_nsec == 0) return;
    const std::uint64_t time_nsec = first_nsec + offset_nsec;
    const double status_from_s = static_cast<double>(offset_nsec) * 1e-9 - kStatusSearchS;
    std::vector<std::string> problems;
    std::vector<std::string> rare = kept;
    std::vector<std::string> statuses;
    if (std::erase(rare, msg::TOPIC_STATUS) > 0) statuses.push_back(msg::TOPIC_STATUS);
    const bool has_inputs = std::erase(rare, msg::TOPIC_INPUTS) > 0;
    LastMessages last = last_of_each_key(take, rare, first_nsec, time_nsec, problems);
    last.merge(last_of_each_key(take, statuses, first_nsec + offset_of(status_from_s), time_nsec,
                                problems));
    if (has_inputs) {
      const auto depth =
          static_cast<std::size_t>(dds::qos_of(dds::Topic::kInputs, false, false).history_depth);
      last.merge(last_of_topic(take, msg::TOPIC_INPUTS, depth, time_nsec, problems));
    }
    for (const std::string& problem : problems)
      spdlog::warn("{}: {}", config.take.string(), problem);
    for (const auto& [place, newest] : last) {
      for (const auto& data : newest) send({.channel_id = place.first, .data = data});
    }
  }

  void play() {
    if (config.waits_for_readers) wait_for_readers();
    mcap::MessageCursor cursor = cursor_at(begin_nsec);
    mcap::Message message;
    bool has_message = false;
    std::unique_lock lock(mutex);
    since = Clock::now();
    while (!ending) {
      if (jump_to) {
        const std::uint64_t wanted = *jump_to;
        const std::uint64_t target = std::min(wanted, end_nsec);
        lock.unlock();
        restore(target);
        cursor = cursor_at(target);
        has_message = cursor.next(message);
        lock.lock();
        position_nsec = target;
        since = Clock::now();
        over = false;
        if (jump_to == wanted) jump_to.reset();  // else another jump was asked for meanwhile
        continue;
      }
      if (!has_message) {
        if (finish()) continue;
        changed.wait_for(lock, kLongestWait);
        continue;
      }
      const std::uint64_t due = message.log_time_nsec - first_nsec;
      const bool single = paused && steps > 0;
      if (single) {
        --steps;
        position_nsec = std::max(position_nsec, due);
      } else if (paused) {
        changed.wait_for(lock, kLongestWait);
        continue;
      } else if (const std::uint64_t now = position_now(); now < due) {
        constexpr double kLongestNsec = std::chrono::nanoseconds(kLongestWait).count();
        const double left = std::min(static_cast<double>(due - now) / rate, kLongestNsec);
        changed.wait_for(lock, std::chrono::nanoseconds(static_cast<std::int64_t>(left)));
        continue;
      }
      lock.unlock();
      send(message);
      has_message = cursor.next(message);
      lock.lock();
    }
  }

  /// At the end of the take; the lock is held. @return true when it goes on
  bool finish() {
    if (!paused && position_now() < end_nsec) return false;  // the silence before the end
    if (config.loop && !paused) {
      jump_to = begin_nsec;
      return true;
    }
    position_nsec = end_nsec;
    over = true;
    return false;
  }

  template <class Change>
  void change(Change apply) {
    {
      const std::lock_guard lock(mutex);
      rebase();
      apply();
    }
    changed.notify_one();
    if (status) status->publish_now();
  }

  void pause(bool wanted) {
    change([&] {
      paused = wanted;
      steps = 0;
    });
  }

  /// The lock is held.
  void add_steps(std::uint64_t more) {
    constexpr auto kLimit = static_cast<std::uint64_t>(kMaxSteps);
    steps = std::min(steps + std::min(more, kLimit), kLimit);
  }

  void jump(std::uint64_t offset_nsec) {
    change([&] {
      jump_to = std::min(offset_nsec, end_nsec);
      steps = 0;
    });
  }

  node::Answer execute(const msg::ControlCommand& command) {
    const std::string& argument = command.argument();
    const std::optional<double> number = number_in(argument);
    switch (command.verb()) {
      case msg::VERB_PAUSE:
        pause(true);
        return {true, position_text()};
      case msg::VERB_RESUME:
        pause(false);
        return {true, position_text()};
      case msg::VERB_STEP: {
        const double wanted = argument.empty() ? 1.0 : number.value_or(0.0);
        if (!(wanted >= 1.0) || wanted > kMaxSteps || wanted != std::floor(wanted))
          return {false, fmt::format("'step' needs a number of messages from 1 to {:.0f}, got '{}'",
                                     kMaxSteps, argument)};
        change([&] {
          paused = true;
          add_steps(static_cast<std::uint64_t>(wanted));
        });
        return {true,
                position_text() + (wanted > 1.0 ? fmt::format(", and plays {:.0f} messages", wanted)
                                                : ", and plays the next message")};
      }
      case msg::VERB_RESET:
        jump(begin_nsec);
        return {true, position_text()};
      case msg::VERB_SEEK:
        if (!number || !(*number >= 0.0))
          return {false, "'seek' needs a time in seconds, from 0 on"};
        jump(offset_of(*number));
        return {true, position_text()};
      case msg::VERB_RATE:
        if (!number || *number < kSlowestRate || *number > kFastestRate)
          return {false, fmt::format("'rate' needs a number from {:g} to {:g}, got '{}'",
                                     kSlowestRate, kFastestRate, argument)};
        change([&] { rate = *number; });
        return {true, fmt::format("plays {:g} times as fast as it was recorded", *number)};
      case msg::VERB_GET:
        return {false, "a take is played: it has no parameters to ask for"};
      default:
        return {false, "a take is played: '" + node::word_of(command.verb()) +
                           "' would change nothing of it"};
    }
  }

  std::string position_text() const {
    const TakePlayerFigures now = figures();
    return fmt::format("{} at {:.3f} of {:.3f} s", now.paused ? "paused" : "goes on",
                       now.position_s, now.length_s);
  }
};

TakePlayer::TakePlayer(TakePlayerConfig config)
    : impl_(std::make_unique<Impl>(std::move(config))) {}

TakePlayer::~TakePlayer() = default;

TakePlayerFigures TakePlayer::figures() const {
  return impl_->figures();
}

const std::string& TakePlayer::damage() const noexcept {
  return impl_->take.damage();
}

void TakePlayer::pause(bool paused) {
  impl_->pause(paused);
}

void TakePlayer::step(std::uint64_t messages) {
  impl_->change([this, messages] { impl_->add_steps(messages); });
}

void TakePlayer::seek(double position_s) {
  impl_->jump(impl_->offset_of(position_s));
}

void TakePlayer::set_rate(double rate) {
  impl_->change([this, rate] { impl_->rate = std::clamp(rate, kSlowestRate, kFastestRate); });
}

}  // namespace cordis::record
