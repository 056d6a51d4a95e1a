// device_node/drivers/gestures.cpp
#include "device_node/drivers/gestures.h"

#include <string>
#include <utility>

namespace cordis::device {
namespace {

using config::MappingReader;
using config::Problems;
using config::Range;

const Range kPlace = Range::between(-1.0, 1.0);  // [m]
constexpr std::size_t kFingerAxes = 4;           // x0, y0, x1, y1

/// The path of several axes, written down leg by leg.
class Score {
 public:
  explicit Score(std::vector<double> start) : start_(start), here_(std::move(start)) {
    moves_.resize(here_.size());
  }

  void wait(double duration_s) { now_s_ += duration_s; }

  /// All axes go where they are sent, at the same time.
  void go(const std::vector<double>& target, double duration_s) {
    for (std::size_t a = 0; a < moves_.size(); ++a) {
      if (target[a] != here_[a]) moves_[a].push_back({now_s_, duration_s, target[a]});
    }
    here_ = target;
    now_s_ += duration_s;
  }

  double now_s() const noexcept { return now_s_; }

  /// @param repeats  from the end on, all over again
  std::vector<Trajectory> paths(Trajectory::Shape shape, bool repeats) const {
    std::vector<Trajectory> paths;
    for (std::size_t a = 0; a < moves_.size(); ++a) {
      paths.emplace_back(start_[a], moves_[a], shape, repeats ? now_s_ : 0.0);
    }
    return paths;
  }

 private:
  std::vector<double> start_;
  std::vector<double> here_;
  std::vector<std::vector<Trajectory::Move>> moves_;
  double now_s_ = 0.0;
};

/// What all gestures share.
struct Tempo {
  double after_s = 0.0;
  double stay_s = 0.0;
  bool repeats = true;
};

Tempo read_tempo(MappingReader& reader) {
  Tempo tempo;
  tempo.after_s = reader.optional_number("after_s", 0.3, Range::not_negative());
  tempo.stay_s = reader.optional_number("stay_s", 0.5, Range::not_negative());
  tempo.repeats = reader.optional_truth("repeats", true);
  return tempo;
}

std::vector<Trajectory> hold(MappingReader& reader, std::size_t axis_count) {
  std::vector<double> position = reader.required_numbers("at_m");
  if (position.size() != 1 && position.size() != axis_count && reader.ok()) {
    reader.error_at("at_m", "at_m must be one number, or one per axis of the hand");
  }
  position.resize(axis_count, position.front());
  return Score(position).paths(Trajectory::Shape::kMinimumJerk, false);
}

/// Down to a depth in a time, and up again in another: pressing and plucking.
std::vector<Trajectory> down_and_up(MappingReader& reader, double up_s) {
  const Tempo tempo = read_tempo(reader);
  const double above = reader.optional_number("above_m", 0.005, kPlace);
  const double depth = reader.required_number("depth_m", kPlace);
  const double reach_s = reader.optional_number("in_s", 0.8, Range::positive());
  Score score({above});
  score.wait(tempo.after_s);
  score.go({depth}, reach_s);
  score.wait(tempo.stay_s);
  score.go({above}, up_s > 0.0 ? up_s : reach_s);
  score.wait(tempo.stay_s);
  return score.paths(Trajectory::Shape::kMinimumJerk, tempo.repeats);
}

std::vector<Trajectory> bow(MappingReader& reader, std::size_t axis_count) {
  const Tempo tempo = read_tempo(reader);
  const double stroke = reader.required_number("stroke_m", Range::between(1e-4, 1.0));
  const double speed = reader.required_number("speed_m_per_s", Range::positive());
  const double middle = reader.optional_number("middle_m", 0.0, kPlace);
  const double above = reader.optional_number("above_m", 0.0, kPlace);
  const double depth = reader.optional_number("depth_m", 0.0, kPlace);
  const auto point = [axis_count](double along, double press) {
    std::vector<double> all(axis_count, press);
    all[0] = along;
    return all;
  };
  Score score(point(middle - 0.5 * stroke, above));
  score.wait(tempo.after_s);
  score.go(point(middle - 0.5 * stroke, depth), 0.2);
  score.go(point(middle + 0.5 * stroke, depth), stroke / speed);
  score.wait(tempo.stay_s);
  score.go(point(middle - 0.5 * stroke, depth), stroke / speed);
  score.go(point(middle - 0.5 * stroke, above), 0.2);
  return score.paths(Trajectory::Shape::kLinear, tempo.repeats);
}

/// Two fingers, each `half` from the middle, at a point [m].
std::vector<double> fingers(double half, double x, double y) {
  return {x - half, y, x + half, y};
}

std::vector<Trajectory> grasp_and_drag(MappingReader& reader) {
  const Tempo tempo = read_tempo(reader);
  const double open = reader.required_number("open_m", kPlace);
  const double grip = reader.required_number("grip_m", kPlace);
  const std::vector<double> drag = reader.required_numbers("drag_m", 2);
  const std::vector<double> from = reader.optional_numbers("from_m", {0.0, 0.0}, 2);
  const double leg_s = reader.optional_number("in_s", 0.8, Range::positive());
  Score score(fingers(open, from[0], from[1]));
  score.wait(tempo.after_s);
  score.go(fingers(grip, from[0], from[1]), leg_s);
  score.go(fingers(grip, from[0] + drag[0], from[1] + drag[1]), leg_s);
  score.wait(tempo.stay_s);
  score.go(fingers(open, from[0] + drag[0], from[1] + drag[1]), leg_s);
  score.go(fingers(open, from[0], from[1]), leg_s);
  return score.paths(Trajectory::Shape::kMinimumJerk, tempo.repeats);
}

std::vector<Trajectory> knead(MappingReader& reader) {
  const Tempo tempo = read_tempo(reader);
  const double open = reader.required_number("open_m", kPlace);
  const double grip = reader.required_number("grip_m", kPlace);
  const double depth = reader.optional_number("depth_m", 0.0, kPlace);
  const std::vector<double> from = reader.optional_numbers("from_m", {0.0, 0.0}, 2);
  const double leg_s = reader.optional_number("in_s", 0.8, Range::positive());
  const long times = reader.optional_integer("times", 2, 1, 1000);
  Score score(fingers(open, from[0], from[1]));
  score.wait(tempo.after_s);
  for (long n = 0; n < times; ++n) {
    score.go(fingers(grip, from[0], from[1] + depth), leg_s);
    score.wait(tempo.stay_s);
    score.go(fingers(open, from[0], from[1]), leg_s);
  }
  return score.paths(Trajectory::Shape::kMinimumJerk, tempo.repeats);
}

std::vector<Trajectory> read_words(MappingReader& reader, std::size_t axis_count) {
  const std::string kind = reader.required_choice(
      "kind", {"hold", "reach_and_press", "pluck", "bow", "grasp_and_drag", "knead"});
  if (!reader.ok()) {  // nothing is known of the other keys of a gesture without a kind
    for (const std::string& key : reader.present_keys()) reader.optional_value(key);
    return {};
  }
  if ((kind == "grasp_and_drag" || kind == "knead") && axis_count != kFingerAxes) {
    reader.error_at("kind", "'" + kind + "' needs a hand on four axes: x0, y0, x1, y1");
    return {};
  }
  if (kind == "hold") return hold(reader, axis_count);
  if (kind == "reach_and_press") return down_and_up(reader, 0.0);
  if (kind == "pluck") return down_and_up(reader, 0.06);
  if (kind == "bow") return bow(reader, axis_count);
  return kind == "knead" ? knead(reader) : grasp_and_drag(reader);
}

/// One path per axis, or one for all where every to_m is one number.
std::vector<Trajectory> read_moves(MappingReader& hand, std::size_t axis_count,
                                   Problems& problems) {
  const double start_m = hand.optional_number("start_m", 0.005, kPlace);
  const config::Value sequence = hand.optional_sequence("moves");
  std::vector<std::vector<Trajectory::Move>> moves(axis_count);
  double free_from_s = 0.0;
  for (const config::Value& item : sequence.items()) {
    MappingReader reader(item, "move", problems);
    const double begin_s = reader.required_number("at_s", Range::not_negative());
    const double duration_s = reader.required_number("in_s", Range::not_negative());
    std::vector<double> target = reader.required_numbers("to_m");
    reader.finish();
    if (reader.ok() && begin_s < free_from_s - Trajectory::kTimeResolution) {
      reader.error_at("at_s", "a move must not begin before the one before it has ended");
    }
    if (reader.ok() && target.size() != 1 && target.size() != axis_count) {
      reader.error_at("to_m", "to_m must be one number, or one per axis of the hand: " +
                                  std::to_string(axis_count) + ", got " +
                                  std::to_string(target.size()));
    }
    for (const double value : target) {
      if (reader.ok() && !(value >= -1.0 && value <= 1.0)) {
        reader.error_at("to_m", "to_m must be within -1 and 1, got " + config::number_text(value));
      }
    }
    if (!reader.ok()) continue;
    target.resize(axis_count, target.front());
    for (std::size_t a = 0; a < axis_count; ++a)
      moves[a].push_back({begin_s, duration_s, target[a]});
    free_from_s = begin_s + duration_s;
  }
  const double repeat_s = hand.optional_number("repeat_s", 0.0, Range::not_negative());
  if (repeat_s != 0.0 && repeat_s < free_from_s - Trajectory::kTimeResolution) {
    hand.error_at("repeat_s", "repeat_s must not be less than the end of the last move");
  }
  if (problems.has_errors()) return {};
  std::vector<Trajectory> paths;
  for (auto& path : moves) {
    paths.emplace_back(start_m, std::move(path), Trajectory::Shape::kMinimumJerk, repeat_s);
  }
  return paths;
}

}  // namespace

std::vector<Trajectory> read_gesture(MappingReader& hand, std::size_t axis_count,
                                     Problems& problems) {
  std::vector<Trajectory> paths;
  if (hand.has("gesture")) {
    for (const char* other : {"start_m", "moves", "repeat_s"}) {
      if (!hand.has(other)) continue;
      hand.error_at(other, "a hand has either a gesture or moves of its own");
      hand.optional_value(other);
    }
    MappingReader reader(hand.optional_mapping("gesture"), "gesture", problems);
    paths = read_words(reader, axis_count);
    reader.finish();
  } else {
    paths = read_moves(hand, axis_count, problems);
  }
  if (problems.has_errors() || paths.empty()) return {Trajectory()};
  return paths;
}

}  // namespace cordis::device
