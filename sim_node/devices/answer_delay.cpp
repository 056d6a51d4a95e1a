// sim_node/devices/answer_delay.cpp
#include "sim_node/devices/answer_delay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim_node/checks/port_check.h"

namespace cordis::sim {

/// Bin 0 holds what is shorter than 2^-20 s; the others 32 equal steps of every octave.
std::size_t AnswerDelayHistogram::bin_of(double delay_s) noexcept {
  int octave = 0;
  const double mantissa = std::frexp(std::ldexp(delay_s, kOctaves), &octave);  // [1/2, 1)
  if (octave < 1) return 0;
  const auto step = static_cast<std::size_t>((2.0 * mantissa - 1.0) * kStepsPerOctave);
  return std::min(1 + static_cast<std::size_t>(octave - 1) * kStepsPerOctave + step, kBins - 1);
}

double AnswerDelayHistogram::upper_end_s(std::size_t bin) noexcept {
  if (bin == 0) return std::ldexp(1.0, -static_cast<int>(kOctaves));
  const std::size_t octave = (bin - 1) / kStepsPerOctave;
  const auto steps = static_cast<double>((bin - 1) % kStepsPerOctave + 1);
  return std::ldexp(1.0 + steps / kStepsPerOctave,
                    static_cast<int>(octave) - static_cast<int>(kOctaves));
}

bool AnswerDelayHistogram::record(double delay_s) noexcept {
  if (!(delay_s > 0.0 && delay_s <= kLongest)) return false;
  Bins& bins = windows_[current_.load(std::memory_order_relaxed)];
  bins[bin_of(delay_s)].fetch_add(1, std::memory_order_relaxed);
  return true;
}

void AnswerDelayHistogram::drop_old(std::int64_t now_nsec) noexcept {
  if (begun_nsec_ == 0) begun_nsec_ = now_nsec;
  if (now_nsec - begun_nsec_ < kWindowNsec) return;
  const bool both = now_nsec - begun_nsec_ >= 2 * kWindowNsec;
  begun_nsec_ = now_nsec;
  const std::size_t older = 1 - current_.load(std::memory_order_relaxed);
  for (auto& bin : windows_[older]) bin.store(0, std::memory_order_relaxed);
  current_.store(older, std::memory_order_relaxed);
  if (!both) return;
  for (auto& bin : windows_[1 - older]) bin.store(0, std::memory_order_relaxed);
}

std::uint64_t AnswerDelayHistogram::count() const noexcept {
  std::uint64_t count = 0;
  for (const Bins& window : windows_) {
    for (const auto& bin : window) count += bin.load(std::memory_order_relaxed);
  }
  return count;
}

double AnswerDelayHistogram::quantile_s(double share) const noexcept {
  std::array<double, kBins> counts{};
  double count = 0.0;
  double sum_s = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    for (const Bins& window : windows_)
      counts[bin] += static_cast<double>(window[bin].load(std::memory_order_relaxed));
    count += counts[bin];
    sum_s += counts[bin] * upper_end_s(bin);
  }
  if (count == 0.0) return 0.0;
  double seen = 0.0;
  std::size_t bin = 0;
  for (; bin + 1 < kBins; ++bin) {
    seen += counts[bin];
    if (seen > 0.0 && seen >= share * count) break;
  }
  return std::max(upper_end_s(bin), sum_s / count);
}

void AnswerDelayHistogram::clear() noexcept {
  for (Bins& window : windows_) {
    for (auto& bin : window) bin.store(0, std::memory_order_relaxed);
  }
  begun_nsec_ = 0;
}

AnswerDelays::Process* AnswerDelays::find(std::uint64_t epoch) noexcept {
  Process* process = std::ranges::find_if(
      processes_, [epoch](const Process& other) { return other.epoch.load() == epoch; });
  return epoch == 0 || process == processes_.end() ? nullptr : process;
}

void AnswerDelays::add(std::uint64_t epoch, double rate_hz, std::int64_t now_nsec) noexcept {
  if (find(epoch) != nullptr) return;
  Process& process = *std::ranges::min_element(
      processes_, {}, [](const Process& other) { return other.newest_nsec.load(); });
  if (process.epoch.load() != 0 && now_nsec - process.newest_nsec.load() < kSilentNsec) return;
  process.epoch.store(0);
  process.delays.clear();
  process.rate_hz.store(rate_hz);
  process.newest_nsec.store(now_nsec);
  process.epoch.store(epoch);
}

void AnswerDelays::record(std::uint64_t epoch, const Report& report,
                          std::int64_t now_nsec) noexcept {
  Process* found = find(epoch);
  if (found == nullptr) return;
  Process& process = *found;
  process.newest_nsec.store(now_nsec, std::memory_order_relaxed);
  const Report before = std::exchange(process.before, report);
  const bool is_first = std::exchange(process.seen_epoch, epoch) != epoch;
  if (is_first) process.turns = {};
  process.taken_sample = report.sample;
  process.taken_nsec = now_nsec;
  const bool is_new = is_first || before.answered_sample != report.answered_sample;
  const double period_s = 1.0 / process.rate_hz.load();
  const bool follows = !is_first && report.sample > before.sample;
  const std::uint64_t lost = follows ? report.sample - before.sample - 1 : 0;
  process.waited_s = is_new ? 0.0 : process.waited_s + (static_cast<double>(lost) + 1.0) * period_s;
  if (!(report.delay_s > 0.0 && report.delay_s <= AnswerDelayHistogram::kLongest)) return;
  const double delay_s = std::max(report.delay_s, min_delay_s(process, report.answered_sample));
  process.before.delay_s = delay_s;
  const double given_up_s = std::max(kGivenUp, kGivenUpPeriods * period_s);
  if (process.waited_s <= given_up_s) process.delays.record(delay_s + process.waited_s);
  // At each lost sample the position that is felt was a period younger than at the next. Of them count
  // those before the force of the answer before was given up.
  const double min_s = std::max(std::min(delay_s, before.delay_s), kFastestAnswer);
  const double held_s = is_new ? delay_s - min_s : process.waited_s;
  const double off = std::ceil((held_s - given_up_s) / period_s);  // samples at which it was off
  const double first = std::max(1.0, off);
  for (std::uint64_t n = 0; n < kMaxLost; ++n) {
    const double ago = first + static_cast<double>(n);
    if (ago > static_cast<double>(lost)) break;
    process.delays.record(std::max(delay_s + process.waited_s - ago * period_s, min_s));
  }
}

void AnswerDelays::answer(std::uint64_t epoch, std::uint64_t sample, std::uint64_t answer,
                          std::int64_t now_nsec) noexcept {
  Process* process = find(epoch);
  if (process == nullptr || process->seen_epoch != epoch || process->taken_sample != sample) return;
  Turn& turn = process->turns[answer % process->turns.size()];
  turn = {answer, static_cast<double>(now_nsec - process->taken_nsec) * 1e-9};
}

/// The least that the delay of an answer can have been.
double AnswerDelays::min_delay_s(const Process& process, std::uint64_t answered_sample) noexcept {
  const Turn& turn = process.turns[answered_sample % process.turns.size()];
  return turn.answer == answered_sample ? std::max(kFastestAnswer, turn.took_s) : kFastestAnswer;
}

void AnswerDelays::leave_out(std::uint64_t epoch, std::int64_t now_nsec) noexcept {
  Process* process = find(epoch);
  if (process == nullptr) return;
  process->newest_nsec.store(now_nsec, std::memory_order_relaxed);
  process->seen_epoch = 0;
}

std::optional<double> AnswerDelays::delay_s(std::uint64_t epoch, std::int64_t now_nsec) noexcept {
  Process* process = find(epoch);
  if (process == nullptr) return {};
  process->delays.drop_old(now_nsec);
  if (process->delays.count() < enough_answers(process->rate_hz.load())) return {};
  return process->delays.quantile_s(quantile_);
}

double DelayInUse::with_room(double measured) const noexcept {
  const double wanted = kRoom * measured;
  const bool is_at_assumed = wanted >= assumed_ && measured <= kAtAssumed * assumed_;
  return is_at_assumed ? std::max(measured, assumed_) : wanted;
}

bool DelayInUse::update(std::optional<double> measured, std::int64_t now_nsec) noexcept {
  const double before = periods_;
  const bool was_measured = is_measured_;
  const double wanted = measured ? with_room(*measured) : std::max(assumed_, periods_);
  is_measured_ = measured.has_value();
  const bool is_low = measured && was_measured && wanted * kWell < periods_;
  if (is_low && low_since_nsec_ != 0) largest_low_ = std::max(largest_low_, wanted);
  if (is_low && low_since_nsec_ == 0) {
    low_since_nsec_ = now_nsec;
    largest_low_ = wanted;
  }
  if (!is_low) low_since_nsec_ = 0;
  if (!measured || !was_measured || *measured > periods_) {
    periods_ = wanted;
  } else if (is_low && now_nsec - low_since_nsec_ >= kCalmNsec) {
    periods_ = largest_low_;
    low_since_nsec_ = 0;
  }
  return periods_ != before || is_measured_ != was_measured;
}

}  // namespace cordis::sim
