// cli/scene_source/live_source.cpp
#include "cli/scene_source/live_source.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include <unistd.h>

#include "cli/session_address.h"
#include "node/stop.h"
#include "viz_node/scene_check.h"

namespace cordis::cli {
namespace {

constexpr std::chrono::seconds kLivePatience{10};  // until a session counts as silent
constexpr std::chrono::milliseconds kLiveWait{100};

template <class Message>
bool is_of(const Message& message, const msg::SceneDescription& description) {
  return message.epoch() == description.epoch() && message.version() == description.version();
}

}  // namespace

LiveSource::LiveSource(const std::string& session, const std::string& domain) : session_(session) {
  const SessionAddress address = address_of(session, domain, "");
  dds::ParticipantConfig config{address.domain, address.session,
                                "cordis " + std::to_string(getpid())};
  config.network = address.network;
  config.security = security_for(address, node::Role::kController);
  participant_ = std::make_unique<dds::Participant>(config);
  descriptions_ =
      std::make_unique<dds::Reader<msg::SceneDescription>>(*participant_, dds::Topic::kDescription);
  frames_ = std::make_unique<dds::Reader<msg::SceneFrame>>(*participant_, dds::Topic::kFrame);
  signals_ = std::make_unique<dds::Reader<msg::SceneSignals>>(*participant_, dds::Topic::kSignals);
  if (!wait_for(*descriptions_, description_))
    throw std::runtime_error(
        with_reason("session '" + session + "' describes no scene: has it a sim_node?",
                    participant_->mismatch()));
  while (descriptions_->take(description_)) {
  }
  const std::string fault = viz::fault_of(description_);
  if (!fault.empty()) throw std::runtime_error("the scene of '" + session + "': " + fault);
  msg::SceneFrame frame;
  if (!next(frame)) throw std::runtime_error("session '" + session + "' sends no frames");
  first_s_ = frame.simulated_s();
  first_ = std::move(frame);
}

template <class Message>
bool LiveSource::wait_for(dds::Reader<Message>& reader, Message& message) {
  const auto end = std::chrono::steady_clock::now() + kLivePatience;
  while (!node::stop_requested() && std::chrono::steady_clock::now() < end) {
    if (reader.take(message)) return true;
    reader.wait(kLiveWait);
  }
  return false;
}

bool LiveSource::next(msg::SceneFrame& frame) {
  if (first_) {
    frame = *std::exchange(first_, std::nullopt);
    return true;
  }
  while (!is_over_ && wait_for(*frames_, frame)) {
    if (!is_of(frame, description_)) {
      if (frame.epoch() == description_.epoch() && frame.version() < description_.version())
        continue;  // of the scene before
      notes_.push_back("the session plays another scene now, or its scene began again");
      is_over_ = true;
      return false;
    }
    if (viz::fault_of(frame, description_).empty()) return true;
  }
  if (!is_over_ && !node::stop_requested())
    notes_.push_back("session '" + session_ + "' sends nothing any more");
  is_over_ = true;
  return false;
}

std::optional<msg::SceneFrame> LiveSource::frame_at(double time_s) {
  const double period_s = 1.0 / description_.frame_rate_hz();
  return picker_.at(time_s, period_s, [this](msg::SceneFrame& frame) { return next(frame); });
}

void LiveSource::read_signals(double from_s, double to_s, SignalSeries& rows,
                              const std::function<bool(double)>& progress) {
  msg::SceneSignals batch;
  const std::size_t columns = description_.signals().size();
  double time_s = from_s;
  while (time_s < to_s && !progress(time_s) && wait_for(*signals_, batch)) {
    if (!is_of(batch, description_) || batch.rate() != msg::RATE_GESTURE) continue;
    if (!viz::fault_of(batch, description_).empty()) continue;
    const std::size_t count = batch.value().size() / columns;
    for (std::size_t row = 0; row < count; ++row) {
      const std::uint64_t step =
          batch.first_step() +
          (row < batch.row_step().size() ? batch.row_step()[row] : row * batch.stride_steps());
      time_s = static_cast<double>(step) / description_.step_rate_hz();
      if (time_s < from_s || time_s > to_s) continue;
      rows.time_s.push_back(time_s);
      const double* values = batch.value().data() + row * columns;
      rows.value.insert(rows.value.end(), values, values + columns);
    }
  }
}

}  // namespace cordis::cli
