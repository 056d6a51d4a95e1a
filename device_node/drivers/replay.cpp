// device_node/drivers/replay.cpp
#include "device_node/drivers/replay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "idl/gesture.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/config/mapping_reader.h"
#include "node/config/name_hash.h"
#include "node/config/nearest_word.h"
#include "node/dds/payload.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/reader.h"

namespace cordis::device {

Replay::Replay(RecordedHand positions, RecordedHand forces, double rate_hz, double from_s,
               bool repeats)
    : OpenLoopDriver(rate_hz),
      positions_(std::move(positions)),
      forces_(std::move(forces)),
      from_s_(from_s),
      repeats_(repeats) {}

bool Replay::can_play(Role role) const noexcept {
  return !(role == Role::kMass ? positions_ : forces_).is_empty();
}

bool Replay::read(AxisValues& sensed) noexcept {
  sensed.fill(0.0);
  const RecordedHand& hand = role() == Role::kMass ? positions_ : forces_;
  if (hand.is_empty()) return true;
  const auto count = static_cast<double>(hand.values.size());
  const double first = std::min(from_s_ * hand.rate_hz, count - 1.0);
  double index = first + period_count() * hand.rate_hz / rate_hz();
  if (repeats_) index = first + std::fmod(index - first, count - first);
  if (index >= count) {
    if (role() == Role::kMass) sensed = hand.values.back();
    return true;
  }
  const auto before = static_cast<std::size_t>(index);
  const std::size_t after = std::min(before + 1, hand.values.size() - 1);
  const double share = index - static_cast<double>(before);
  for (std::size_t a = 0; a < sensed.size(); ++a) {
    const double from = hand.values[before][a];
    sensed[a] = share == 0.0 ? from : from + share * (hand.values[after][a] - from);
  }
  return true;
}

namespace {

constexpr std::uint64_t kMaxPeriods = 4'000'000;  // an hour at 1 kHz: 512 MB
constexpr double kMinRateHz = 1.0;
constexpr double kMaxRateHz = 100'000.0;

/// Collects samples by their numbers; what was lost on the way stays as it was before.
class Collector {
 public:
  void add(const msg::InputSample& sample) {
    AxisValues values{};
    const std::size_t count = std::min(sample.value().size(), values.size());
    for (std::size_t a = 0; a < count; ++a) {
      if (!std::isfinite(sample.value()[a])) return;
      values[a] = sample.value()[a];
    }
    axis_count_ = std::max(axis_count_, count);
    const bool goes_on = sample.epoch() == epoch_ && sample.sample() > number_;
    const std::uint64_t periods = goes_on ? sample.sample() - number_ : 1;
    epoch_ = sample.epoch();
    number_ = sample.sample();
    const bool is_far = periods > kMaxPeriods || values_.size() + periods > kMaxPeriods;
    if (!values_.empty() && !is_far) values_.resize(values_.size() + periods - 1, values_.back());
    values_.push_back(values);
  }

  std::size_t axis_count() const noexcept { return axis_count_; }
  RecordedHand hand(double rate_hz) { return {rate_hz, std::move(values_)}; }

 private:
  std::uint64_t epoch_ = 0;
  std::uint64_t number_ = 0;
  std::size_t axis_count_ = 0;
  std::vector<AxisValues> values_;
};

/// What a take says about its devices, and what one of them gave.
struct Hands {
  std::map<std::uint32_t, std::string> names;  // of the devices that sent samples
  std::map<std::uint32_t, double> rates_hz;
  std::optional<std::uint32_t> collected;  // the wanted device, else the first that sent samples
  Collector positions;
  Collector forces;
};

/// @throws mcap::FileError when messages of the topic cannot be read
template <class Message, class Use>
void each(const mcap::Reader& take, const std::string& topic, Use use) {
  mcap::MessageCursor cursor = take.messages({.topics = {topic}});
  Message message;
  for (mcap::Message raw; cursor.next(raw);) {
    if (dds::decode(raw.data, message)) use(message);
  }
  if (!cursor.problems().empty())
    throw mcap::FileError(take.path().string() + ": " + cursor.problems().front());
}

/// @param wanted  name of a device; empty: the take must have one alone
Hands hands_of(const mcap::Reader& take, const std::string& wanted) {
  Hands hands;
  if (!wanted.empty()) hands.collected = config::name_hash(wanted);
  each<msg::SceneInputs>(take, msg::TOPIC_INPUTS, [&](const msg::SceneInputs& batch) {
    for (const msg::InputSample& sample : batch.sample()) {
      hands.names[sample.device_id()];
      if (!hands.collected) hands.collected = sample.device_id();
      if (sample.device_id() == *hands.collected)
        (sample.gives_positions() ? hands.positions : hands.forces).add(sample);
    }
  });
  each<msg::SceneDescription>(take, msg::TOPIC_DESCRIPTION,
                              [&](const msg::SceneDescription& scene) {
                                for (const msg::PortDescription& port : scene.ports()) {
                                  const auto found = hands.names.find(port.device_id());
                                  if (found != hands.names.end()) found->second = port.device();
                                  hands.rates_hz.emplace(port.device_id(), scene.gesture_rate_hz());
                                }
                              });
  each<msg::DeviceDescription>(take, msg::TOPIC_DEVICE, [&](const msg::DeviceDescription& device) {
    const auto found = hands.names.find(device.device_id());
    if (found == hands.names.end()) return;
    found->second = device.device();
    if (device.rate_hz() > 0.0) hands.rates_hz[device.device_id()] = device.rate_hz();
  });
  return hands;
}

std::string list_of(const Hands& hands) {
  std::string text;
  for (const auto& [id, name] : hands.names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

/// Which device of the take is meant; nothing after a problem.
std::optional<std::uint32_t> chosen(const Hands& hands, const std::string& wanted,
                                    config::MappingReader& reader) {
  if (hands.names.empty()) {
    reader.error_at("take", "no device plays in this take",
                    "it needs the topic " + msg::TOPIC_INPUTS);
    return std::nullopt;
  }
  if (wanted.empty()) {
    if (hands.names.size() == 1) return hands.names.begin()->first;
    reader.error_at("take", "several devices play in this take: " + list_of(hands),
                    "device: NAME chooses one");
    return std::nullopt;
  }
  const std::uint32_t id = config::name_hash(wanted);
  if (hands.names.contains(id)) return id;
  reader.error_at("device",
                  "no device '" + wanted + "' plays in this take, only " + list_of(hands));
  return std::nullopt;
}

/// A path as it is written in a file, seen from that file; one of the command line as it is.
std::string path_from(const config::Place& place, const std::string& path) {
  if (place.line == 0) return path;
  return (std::filesystem::path(place.file).parent_path() / path).string();
}

}  // namespace

std::unique_ptr<Driver> make_replay(const config::Value& section, const AxisLayout& layout,
                                    config::Problems& problems) {
  config::MappingReader reader(section, "replay", problems);
  const std::string path = reader.required_text("take");
  const std::string wanted = reader.optional_text("device", "");
  const double from_s = reader.optional_number("from_s", 0.0, config::Range::not_negative());
  const bool repeats = reader.optional_truth("repeat", false);
  reader.finish();
  if (!reader.ok() || problems.has_errors()) return nullptr;
  try {
    const mcap::Reader take(path_from(reader.place_of("take"), path));
    Hands hands = hands_of(take, wanted);
    const std::optional<std::uint32_t> id = chosen(hands, wanted, reader);
    if (!id) return nullptr;
    const std::size_t axes = std::max(hands.positions.axis_count(), hands.forces.axis_count());
    if (axes != static_cast<std::size_t>(layout.count)) {
      reader.error_at("take", "'" + hands.names.at(*id) + "' of the take has " +
                                  std::to_string(axes) + " axes, this device " +
                                  std::to_string(layout.count));
      return nullptr;
    }
    const auto rate = hands.rates_hz.find(*id);
    const double rate_hz = rate == hands.rates_hz.end() ? layout.rate_hz : rate->second;
    if (!(rate_hz >= kMinRateHz && rate_hz <= kMaxRateHz)) {
      reader.error_at("take", fmt::format("'{}' of the take has a rate of {} Hz, and {} to {} Hz "
                                          "are possible",
                                          hands.names.at(*id), rate_hz, kMinRateHz, kMaxRateHz));
      return nullptr;
    }
    return std::make_unique<Replay>(hands.positions.hand(rate_hz), hands.forces.hand(rate_hz),
                                    layout.rate_hz, from_s, repeats);
  } catch (const mcap::FileError& error) {
    reader.error_at("take", error.what());
    return nullptr;
  }
}

}  // namespace cordis::device
