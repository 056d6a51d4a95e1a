// tests/random_scenes/random_parts.cpp
#include "tests/random_scenes/random_parts.h"

#include <cmath>
#include <random>

#include <fmt/format.h>

#include "tests/random_scenes/random_motion.h"
#include "tests/random_scenes/random_numbers.h"

namespace cordis::test {
namespace {

/// Draws one number in each statement: the order of arguments is the compiler's.
class PartWriter {
 public:
  PartWriter(std::uint32_t seed, int space, PartLaws laws)
      : random_(seed ^ 0x7ed55d16U),
        motion_(seed ^ 0x428a2f98U),
        ports_(seed ^ 0x71374491U),
        space_(space),
        laws_(laws) {}

  RandomParts lines() {
    if (between(0.0, 1.0) > 0.25) return {};
    write_part();
    write_uses();
    if (laws_ == PartLaws::kAll) write_contacts();
    return lines_;
  }

 private:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  double decades(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  bool chance(double share) { return between(0.0, 1.0) < share; }

  /// A vector, or one number in 1 dimension.
  std::string place(double half) {
    if (space_ == 1) return fmt::format("{:.4g}", between(-half, half));
    std::string text = "[";
    for (int axis = 0; axis < space_; ++axis)
      text += fmt::format("{}{:.4g}", axis > 0 ? ", " : "", between(-half, half));
    return text + "]";
  }

  std::string spring() {
    std::string text = fmt::format("stiffness_n_per_m: {:.4g}", decades(5.0, 3000.0));
    const double viscosity = decades(1e-4, 1.0);
    if (laws_ != PartLaws::kSprings && chance(0.6))
      text += fmt::format(", viscosity_n_s_per_m: {:.4g}", viscosity);
    return text;
  }

  std::string without_states() {
    const std::string numbers = spring();
    const bool damped = numbers.find("viscosity") != std::string::npos;
    return fmt::format("{{kind: {}, {}}}", damped ? "spring_damper" : "spring", numbers);
  }

  /// The law between two masses of the part.
  std::string law() {
    const double kind = between(0.0, 1.0);
    if (laws_ != PartLaws::kAll || kind < 0.3) return without_states();
    if (kind < 0.6) {
      const double stiffness = decades(5.0, 3000.0);
      const double viscosity = decades(0.01, 10.0);
      const double force = between(-0.2, 0.2);
      return fmt::format(
          "{{kind: maxwell, stiffness_n_per_m: {:.4g}, viscosity_n_s_per_m: {:.4g}, start_force_n: "
          "{:.4g}}}",
          stiffness, viscosity, force);
    }
    const std::string tight = spring();
    const std::string loose = spring();
    const double limit = decades(1e-4, 0.1);
    const char* asked = chance(0.5) ? "pace" : "knock";
    return fmt::format(
        "{{states: {{tight: {{{}, exits: [{{to: loose, when: \"{} > {:.4g}\"}}]}}, loose: {{{}, "
        "exits: "
        "[{{to: tight, when: \"age_s > 0.05\"}}]}}}}}}",
        tight, asked, limit, loose);
  }

  void write_part() {
    const double mass = decades(0.001, 0.05);
    lines_.liaisons += "  of_part: " + law() + "\n";
    const std::string at_hub = place(0.02);
    const std::string at_tip = place(0.1);
    const double radius = between(0.01, 0.03);
    const bool is_fixed = chance(0.2);
    leads_ = laws_ != PartLaws::kSprings && motion_.chance(0.2);
    const std::string hub = leads_     ? "fixed" + random_drive_of_position(motion_, space_, 0.02)
                            : is_fixed ? "fixed, at_m: " + at_hub
                                       : "mass, mass_kg: $heavy, at_m: " + at_hub;
    const std::string start = motion_.chance(0.25) ? random_start(motion_, space_) : "";
    const std::string port = perhaps_port();
    lines_.parts =
        fmt::format(R"(parts:
  piece:
    parameters: {{light: {:.4g}, heavy: $light}}
    matter:
      hub: {{kind: {}}}
      tip: {{kind: mass, at_m: {}, ball: {{mass_kg: $light, radius_m: {:.4g}}}{}}}
{}    links:
      - {{liaison: of_part, between: [hub, tip], name: arm}}
{})",
                    mass, hub, at_tip, radius, start, port, port.empty() ? "" : kLinkOfPort);
  }

  /// In two parts of five a port that holds the tip by a spring.
  std::string perhaps_port() {
    has_port_ = ports_.chance(0.4);
    if (!has_port_) return {};
    const bool gives_forces = laws_ == PartLaws::kSprings || ports_.chance(0.4);
    lines_.liaisons += fmt::format("  of_finger: {{kind: spring, stiffness_n_per_m: {:.4g}}}\n",
                                   ports_.decades(5.0, 1000.0));
    const char* more = gives_forces ? ", mass_kg: 0.05" : "";
    if (!gives_forces && ports_.chance(0.4)) more = ", coupling: direct";
    const char* where[] = {"0", "[0, 0.1], along: y", "[0, 0.1, 0], along: y"};
    return fmt::format(
        "    ports:\n      finger: {{device: keys, axes: [0], role: {}, at_m: {}{}}}\n",
        gives_forces ? "liaison" : "mass", where[space_ - 1], more);
  }

  void write_uses() {
    const int copies = 1 + static_cast<int>(between(0.0, 4.0));
    const std::string step = place(0.1);
    const std::string shift = place(0.2);
    const double turn = between(-90.0, 90.0);
    const double heavy = decades(0.001, 0.2);
    const std::string speed = place(1.0);
    const double spin = between(-10.0, 10.0);
    std::string turned;
    std::string spun;
    if (space_ == 2) {
      turned = fmt::format(", rotate_deg: {:.4g}", turn);
      spun = fmt::format(", spin_rad_per_s: {:.4g}", spin);
    } else if (space_ == 3) {
      turned = fmt::format(", rotate: {{axis: [1, 0, 1], deg: {:.4g}}}", turn);
      spun = fmt::format(", spin_rad_per_s: [{:.4g}, 1, 0]", spin);
    }
    std::string use = "part: piece";
    if (space_ > 1) use += ", translate_m: " + shift + turned;
    if (chance(0.5)) use += fmt::format(", parameters: {{heavy: {:.4g}}}", heavy);
    std::string thrown = chance(0.5) ? ", velocity_m_per_s: " + speed : "";
    if (chance(0.3)) thrown += spun;
    use += thrown + perhaps_driven(thrown.empty());
    if (copies > 1) {
      use += fmt::format(", repeat: {{count: {}{}}}", copies,
                         space_ == 1 ? std::string(", layout_translate_m: [0.1, 0]")
                                     : ", translate_m: " + step + turned);
    }
    lines_.matter = "  pieces: {" + use + "}\n";
    const std::string last = copies > 1 ? fmt::format("pieces[{}]", copies - 1) : "pieces";
    lines_.liaisons += "  to_part: " + without_states() + "\n";
    lines_.links = fmt::format("  - {{liaison: to_part, between: [\"p[0]\", \"{}.tip\"]}}\n", last);
    if (copies > 1 && chance(0.5)) {
      lines_.links += fmt::format(
          "  - {{liaison: to_part, between: [\"pieces[0..{}].tip\", \"pieces[1..{}].tip\"]}}\n",
          copies - 2, copies - 1);
    }
    const char* body = is_moved_ ? "p" : "pieces";  // what is moved has no momentum
    lines_.signals = fmt::format("  pace: {{of: {}, quantity: momentum, axis: x}}\n", body);
    lines_.signals += "  strain: {of: pieces.arm, quantity: distance, take: mean}\n";
    if (space_ == 1) return;
    lines_.signals += fmt::format("  turn: {{of: {}, quantity: angular_momentum{}}}\n", body,
                                  space_ == 3 ? ", axis: z" : "");
  }

  /// Half of the parts without a port are pushed as a whole, or moved where nothing of it has a velocity.
  std::string perhaps_driven(bool is_at_rest) {
    if (laws_ == PartLaws::kSprings || has_port_ || leads_ || motion_.chance(0.5)) return {};
    const bool may_move = is_at_rest && lines_.parts.find("velocity_m_per_s") == std::string::npos;
    const std::string drive = random_drive_of_part(motion_, space_, may_move);
    is_moved_ = drive.find("displacement_m") != std::string::npos;
    return drive;
  }

  void write_contacts() {
    lines_.liaisons +=
        fmt::format("  of_tips: {{kind: state_machine, {}, pulls: false}}\n", spring());
    lines_.links +=
        "  - {liaison: of_tips, between_sets: [p, pieces.tip], rest_m: 0.03, range_m: 0.03}\n";
    lines_.signals += "  knock: {of: p, by: pieces.tip, quantity: contact_force, axis: x}\n";
  }

  static constexpr const char* kLinkOfPort =
      "      - {liaison: of_finger, between: [finger, tip]}\n";

  std::mt19937 random_;
  RandomNumbers motion_;  // of starts and drives
  RandomNumbers ports_;
  int space_;
  PartLaws laws_;
  bool has_port_ = false;
  bool leads_ = false;     // its hub goes along a function of time
  bool is_moved_ = false;  // all of it
  RandomParts lines_;
};

}  // namespace

RandomParts random_parts(std::uint32_t seed, int space, PartLaws laws) {
  return PartWriter(seed, space, laws).lines();
}

}  // namespace cordis::test
