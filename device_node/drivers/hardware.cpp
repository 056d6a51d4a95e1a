// device_node/drivers/hardware.cpp
#include "device_node/drivers/hardware.h"

#include <algorithm>
#include <utility>

#include "device_node/drivers/guardian.h"
#include "node/time.h"

namespace cordis::device {
namespace {

std::int64_t nsec_of(double seconds) noexcept {
  return static_cast<std::int64_t>(seconds * 1e9);
}

constexpr std::int64_t kGreetingPatience = 3'000'000'000;  // [ns]
constexpr std::int64_t kGreetAgainAfter = 250'000'000;     // [ns]
constexpr std::int64_t kLetGoFor = 100'000'000;            // after the board said so last [ns]
constexpr double kLongestLoss = 0.2;                       // [s]
constexpr double kLongestLossPeriods = 6.0;                // where these last longer

}  // namespace

Hardware::Hardware(std::unique_ptr<Wire> wire, const HardwareSettings& settings,
                   const AxisLayout& layout)
    : wire_(std::move(wire)), settings_(settings), layout_(layout), guard_(settings.guard) {}

Hardware::~Hardware() {
  lose();
}

void Hardware::start(Role role) noexcept {
  role_ = role;
  coupling_n_.fill(0.0);
  moving_ = false;
  guard_.start();
  const std::int64_t now = node::monotonic_nsec();
  if (contact_ == Contact::kLost) try_to_open(now);
  if (contact_ == Contact::kPresent) ask({});
}

bool Hardware::read(AxisValues& sensed) noexcept {
  sensed.fill(0.0);
  for (std::size_t a = 0; a < static_cast<std::size_t>(layout_.count); ++a) {
    sensed[a] = role_ == Role::kMass ? position_[a] : -coupling_n_[a];
  }
  return contact_ == Contact::kPresent;
}

bool Hardware::write(const AxisValues& commanded) noexcept {
  const std::int64_t now = node::monotonic_nsec();
  is_let_go_ = false;
  report_repeats(now);
  if (contact_ == Contact::kLost) try_to_open(now);
  if (contact_ != Contact::kLost) listen(now);  // what came late answers an earlier request
  if (contact_ == Contact::kGreeting && now >= next_greeting_nsec_) greet_now(now);
  if (contact_ == Contact::kGreeting && !greets_) ask({});
  is_let_go_ = is_let_go_ || now < let_go_until_nsec_;
  if (was_released()) hold_motors(now + kLetGoFor);
  if (contact_ == Contact::kPresent) {
    const bool to_drive = !is_let_go_;
    ask(!to_drive ? AxisValues{} : role_ == Role::kMass ? commanded : coupling_forces(commanded));
    late_ += !listen(now + nsec_of(settings_.answer_within_s));
  }
  if (contact_ != Contact::kLost && is_silent(node::monotonic_nsec())) lose();
  return contact_ == Contact::kPresent && !is_let_go_;
}

/// No force in this period, and until that moment.
void Hardware::hold_motors(std::int64_t until_nsec) noexcept {
  let_go_until_nsec_ = std::max(let_go_until_nsec_, until_nsec);
  is_let_go_ = true;
  coupling_n_.fill(0.0);
  guard_.start();
  moving_ = false;
}

/// True once after the guardian has taken the forces away.
bool Hardware::was_released() noexcept {
  const Guardian* const guardian = Guardian::of_process();
  if (guardian == nullptr) return false;
  const std::uint32_t releases = guardian->release_count();
  return std::exchange(releases_seen_, releases) != releases;
}

bool Hardware::is_silent(std::int64_t now) const noexcept {
  const std::int64_t patience =
      contact_ == Contact::kPresent ? nsec_of(settings_.lost_after_s) : kGreetingPatience;
  return now - last_sample_nsec_ > patience;
}

void Hardware::stop() noexcept {
  coupling_n_.fill(0.0);
  if (contact_ == Contact::kPresent) ask({});  // which may lose the device
  if (contact_ == Contact::kGreeting) release_motors();
  if (contact_ == Contact::kLost && may_hold_force_) {
    next_try_nsec_ = 0;
    try_to_open(node::monotonic_nsec());  // greets with no force
  }
}

/// The motors of a board that does not answer.
void Hardware::release_motors() noexcept {
  if (may_hold_force_) wire_->release();
}

void Hardware::try_to_open(std::int64_t now) noexcept {
  if (now < next_try_nsec_) return;
  next_try_nsec_ = now + nsec_of(settings_.retry_s);
  ReleaseFrame frame;
  frame.length = release(frame.bytes);
  wire_->set_release(frame);
  if (!wire_->open()) return;
  last_sample_nsec_ = now;
  contact_ = Contact::kGreeting;
  greet_now(now);
}

void Hardware::greet_now(std::int64_t now) noexcept {
  next_greeting_nsec_ = now + kGreetAgainAfter;
  release_motors();
  begin();
  Message message;
  const std::size_t count = greet(message);
  greets_ = count > 0;
  if (greets_) static_cast<void>(wire_->send({message.data(), count}));
}

/// The board has restarted behind an open wire.
void Hardware::restart() noexcept {
  hold_motors(0);
  contact_ = Contact::kGreeting;
  last_sample_nsec_ = node::monotonic_nsec();
  greet_now(last_sample_nsec_);
}

/// The device is the right one, and present with its first sample.
void Hardware::welcome() noexcept {
  greets_ = false;
  Message message;
  const std::size_t count = configure(message);
  if (count > 0) static_cast<void>(wire_->send({message.data(), count}));
}

void Hardware::ask(const AxisValues& force_n) noexcept {
  Message message;
  const std::size_t count = request(force_n, message);
  asks_force_ = force_n != AxisValues{};
  may_hold_force_ = may_hold_force_ || asks_force_;
  static_cast<void>(wire_->send({message.data(), count}));  // the next request stands for it
  Guardian* const guardian = Guardian::of_process();
  if (guardian != nullptr) guardian->record_frame(asks_force_);
  if (!wire_->is_open()) lose();
}

/// Takes what is there, and waits until an instant for the answer to the newest request; true when
/// it has come.
bool Hardware::listen(std::int64_t until) noexcept {
  constexpr int kMaxReads = 16;  // beyond that instant: a device that babbles does not stop a hand
  std::array<std::uint8_t, 256> bytes;
  bool found = false;
  bool any = false;
  for (int reads_beyond = 0; reads_beyond < kMaxReads;) {
    const std::int64_t left = until - node::monotonic_nsec();
    const std::size_t count = wire_->receive(
        bytes, std::chrono::nanoseconds(found ? 0 : std::max<std::int64_t>(left, 0)));
    if (!wire_->is_open()) {
      lose();
      return false;
    }
    any = any || count > 0;
    found = take({bytes.data(), count}) || found;
    if (contact_ == Contact::kLost) return false;
    const bool beyond = found || node::monotonic_nsec() >= until;
    if (count == 0 && beyond) break;
    reads_beyond += beyond;
  }
  if (!any) fall_silent();
  return found;
}

/// True when a sample among the bytes answers the newest request.
bool Hardware::take(std::span<const std::uint8_t> bytes) noexcept {
  bool found = false;
  for (const std::uint8_t byte : bytes) {
    const Received received = receive(byte);
    if (received == Received::kWrong) {
      lose();
      return false;
    }
    if (received == Received::kLetGo) hold_motors(node::monotonic_nsec() + kLetGoFor);
    if (received == Received::kLetGoOnce) hold_motors(0);
    if (received == Received::kRestarted) restart();
    const bool sampled = received == Received::kSample || received == Received::kOldSample;
    if (received == Received::kGreeted && greets_) welcome();
    if (sampled) position(position_);
    if (sampled && contact_ == Contact::kGreeting && !greets_) contact_ = Contact::kPresent;
    if (sampled || received == Received::kGreeted) last_sample_nsec_ = node::monotonic_nsec();
    bad_ += received == Received::kBad;
    found = found || received == Received::kSample;
    may_hold_force_ = may_hold_force_ && (asks_force_ || received != Received::kSample);
  }
  return found;
}

void Hardware::lose() noexcept {
  if (contact_ == Contact::kPresent) wire_->release();
  if (contact_ == Contact::kGreeting) release_motors();
  wire_->close();
  contact_ = Contact::kLost;
  coupling_n_.fill(0.0);
  guard_.start();
  moving_ = false;
}

AxisValues Hardware::coupling_forces(const AxisValues& wanted_m) noexcept {
  AxisValues force_n{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(layout_.count); ++a) {
    const double gap = wanted_m[a] - position_[a];
    const double gap_before = moving_ ? wanted_before_[a] - position_before_[a] : gap;
    force_n[a] = settings_.coupling_n_per_m * gap +
                 settings_.coupling_n_s_per_m * (gap - gap_before) * layout_.rate_hz;
  }
  wanted_before_ = wanted_m;
  position_before_ = position_;
  moving_ = true;
  guard_.accept(force_n);
  coupling_n_ = guard_.tick(age_s_, position_);
  return coupling_n_;
}

HardwareSettings read_hardware(config::MappingReader& reader, const AxisLayout& layout,
                               config::Problems& problems) {
  using config::Range;
  HardwareSettings settings;
  settings.answer_within_s = reader.optional_number("answer_within_s", 0.4 / layout.rate_hz,
                                                    Range::between(0.0, 0.9 / layout.rate_hz));
  const double period_s = 1.0 / layout.rate_hz;
  settings.lost_after_s = reader.optional_number(
      "lost_after_s", std::max(0.02, kLongestLossPeriods * period_s),
      Range::between(0.002, std::max(kLongestLoss, kLongestLossPeriods * period_s)));
  settings.retry_s = reader.optional_number("retry_s", 0.5, Range::between(0.01, 60.0));
  config::MappingReader coupling(reader.optional_mapping("coupling"), "coupling", problems);
  settings.coupling_n_per_m =
      coupling.optional_number("stiffness_n_per_m", 300.0, Range::positive());
  settings.coupling_n_s_per_m =
      coupling.optional_number("viscosity_n_s_per_m", 1.0, Range::not_negative());
  coupling.finish();
  settings.guard.limit_n = layout.force_limit_n;
  settings.guard.period_s = 1.0 / layout.rate_hz;
  settings.guard.slew_n_per_s = layout.slew_n_per_s;
  settings.guard.power_w = layout.power_w;
  settings.guard.ramp_s = layout.start_ramp_s;
  settings.guard.watchdog_s = layout.watchdog_s;
  return settings;
}

}  // namespace cordis::device
