// tests/random_scenes/random_scene.cpp
#include "tests/random_scenes/random_scene.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/random_scenes/random_motion.h"
#include "tests/random_scenes/random_numbers.h"
#include "tests/random_scenes/random_parts.h"

namespace cordis::test {
namespace {

/// What the integrator of a scene takes.
enum class Matter { kAnything, kPotentials, kModes };

/// Draws one number in each statement: the order of arguments is the compiler's.
class SceneWriter {
 public:
  explicit SceneWriter(std::uint32_t seed)
      : seed_(seed),
        random_(seed),
        friction_random_(~seed),
        random_of_drives_(seed ^ 0x5bd1e995U),
        random_of_variables_(seed ^ 0x2545f491U),
        random_of_media_(seed ^ 0x1b873593U),
        random_of_bends_(seed ^ 0x9e3779b9U),
        random_of_laws_of_bends_(seed ^ 0x4cf5ad43U),
        random_of_polylines_(seed ^ 0x85ebca6bU),
        random_of_lively_laws_(seed ^ 0x7feb352dU),
        random_of_crowds_(seed ^ 0xd6e8feb8U),
        random_of_fields_(seed ^ 0xc2b2ae35U),
        random_of_bodies_(seed ^ 0x165667b1U),
        random_of_shells_(seed ^ 0x27d4eb2fU),
        random_of_parameters_(seed ^ 0x68e31da4U),
        random_of_still_matter_(seed ^ 0x3c6ef372U),
        random_of_hollows_(seed ^ 0x94d049bbU),
        random_of_rest_(seed ^ 0xbf58476dU),
        random_of_formulas_(seed ^ 0xff51afd7U),
        random_of_places_(seed ^ 0x2127599bU),
        starts_(seed ^ 0xa54ff53aU),
        leads_(seed ^ 0x510e527fU),
        asking_(seed ^ 0x9b05688cU),
        links_asked_(seed ^ 0x1f83d9abU),
        obstacles_(seed ^ 0x5be0cd19U),
        shots_(seed ^ 0x367cd507U),
        nets_(seed ^ 0x3070dd17U),
        beside_(seed ^ 0xf70e5939U),
        counts_(seed ^ 0xffc00b31U) {
    space_ = 1 + static_cast<int>(below(3));
    const std::uint32_t kind = below(16);
    matter_ = kind == 0 ? Matter::kModes : kind <= 2 ? Matter::kPotentials : Matter::kAnything;
    if (matter_ == Matter::kModes) space_ = 1;
    count_ = 1 + below(7);
  }

  std::string text() {
    write_head();
    write_masses();
    if (matter_ != Matter::kPotentials) drive_some();
    if (matter_ == Matter::kAnything) perhaps_push_by_place();
    if (matter_ == Matter::kAnything) perhaps_in_a_medium();
    write_port();
    perhaps_hold_the_body();
    if (matter_ != Matter::kModes && !freezes_ && count_ > 1) add_bends();
    const std::uint32_t links = 1 + below(count_ + 2);
    for (std::uint32_t l = 0; l < links; ++l) add_link(l);
    if (matter_ != Matter::kModes && chance(0.35)) add_set();
    if (matter_ != Matter::kModes && chance(0.3)) add_surfaces();
    if (matter_ == Matter::kAnything) perhaps_add_lively_law();
    if (matter_ == Matter::kAnything) perhaps_add_changing_link();
    if (matter_ == Matter::kAnything) perhaps_add_formulas();
    if (matter_ == Matter::kAnything && !freezes_) perhaps_add_crowd();
    if (matter_ == Matter::kAnything && !freezes_) perhaps_add_shot();
    if (matter_ != Matter::kModes) perhaps_add_body();
    if (space_ > 1) perhaps_add_shell();
    if (space_ > 1) perhaps_add_net();
    if (matter_ != Matter::kModes) perhaps_add_parallel();
    perhaps_count();
    if (matter_ != Matter::kPotentials) perhaps_lead_a_mass();
    RandomParts added;
    if (matter_ != Matter::kModes) added = random_parts(seed_, space_, laws_of_parts());
    if (space_ > 1) perhaps_add_still_matter(added.parts.empty());
    const std::string world_text = world();
    return head_ + world_text + perhaps_settle() + parts_ + added.parts + "liaisons:\n" +
           liaisons_ + added.liaisons + "matter:\n" + masses_ + added.matter +
           (port_.empty() ? "" : "ports:\n" + port_) + "links:\n" + links_ + added.links +
           R"(signals:
  lively: {quantity: kinetic_energy}
  middle: {of: p, quantity: center_of_mass, axis: x}
  fastest: {of: p, quantity: speed, take: largest}
  thrust: {of: p, quantity: force, axis: x, take: sum}
)" + signals_ +
           added.signals;
  }

 private:
  PartLaws laws_of_parts() const {
    if (matter_ == Matter::kPotentials) return PartLaws::kSprings;
    if (freezes_) return PartLaws::kDampedSprings;
    return PartLaws::kAll;
  }

  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  double decades(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  template <class T>
  T one_of(std::initializer_list<T> all) {
    return *(all.begin() + below(static_cast<std::uint32_t>(all.size())));
  }

  /// A place in a box of this half width, or one number in 1 dimension.
  std::string place(double half) {
    if (space_ == 1) return fmt::format("{:.5g}", between(-half, half));
    std::string text = "[";
    for (int axis = 0; axis < space_; ++axis)
      text += fmt::format("{}{:.5g}", axis > 0 ? ", " : "", between(-half, half));
    return text + "]";
  }

  void write_head() {
    std::string integrator;
    if (matter_ == Matter::kModes) {
      integrator = "modal";
    } else if (matter_ == Matter::kPotentials) {
      integrator = "symplectic4";
    } else {
      integrator =
          one_of<const char*>({"cordis", "cordis", "cordis", "leapfrog", "leapfrog", "implicit"});
    }
    freezes_ = integrator == "cordis" && chance(0.1);
    may_rub_ = integrator == "cordis" && !freezes_ && space_ > 1;
    head_ = fmt::format(R"(cordis: 1
name: chance
space: {}
step: {{rate_hz: {}, integrator: {}{}}}
)",
                        space_, one_of({1000, 2000, 5000, 20000, 44000}), integrator,
                        freezes_ ? ", freeze: {tolerance_m: 1.0e-5}" : "");
  }

  std::string world() {
    std::string text;
    const bool may_change = matter_ == Matter::kAnything && !freezes_;
    if (matter_ != Matter::kModes && chance(0.3)) {
      text = "gravity_m_per_s2: [";
      for (int axis = 0; axis < space_; ++axis)
        text += fmt::format("{}{}", axis > 0 ? ", " : "", axis == space_ - 1 ? -9.81 : 0.0);
      text += "]";
    }
    if (may_change && field_between(0.0, 1.0) < 0.1) text = "gravity_m_per_s2: " + field(10.0);
    if (may_change && asking_.chance(0.06)) text = "gravity_m_per_s2: " + asking_field(10.0);
    if (matter_ == Matter::kAnything && chance(0.2)) {
      const double viscosity = decades(1e-4, 0.3);
      const std::string formula = random_viscosity(asking_, viscosity);
      text += text.empty() ? "" : ", ";
      text += "viscosity_n_s_per_m: ";
      text += may_change && asking_.chance(0.3) ? formula : fmt::format("{:.4g}", viscosity);
      if (may_change && field_between(0.0, 1.0) < 0.4 && !has_no_medium_) {
        const std::string flow = field(1.0);
        text += ", flow_m_per_s: " + (asking_.chance(0.5) ? asking_field(1.0) : flow);
      }
    }
    if (text.find("changed") != std::string::npos) signals_ += "  changed: {quantity: changes}\n";
    if (text.find("place_of_wall") != std::string::npos)
      signals_ += "  place_of_wall: {of: wall, quantity: position, axis: x}\n";
    return text.empty() ? "" : "world: {" + text + "}\n";
  }

  double field_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_fields_()) / 4294967296.0;
  }

  /// Numbers or formulas of time for each axis, up to this size.
  std::string field(double size) {
    std::string text = "[";
    for (int axis = 0; axis < space_; ++axis) {
      const double middle = field_between(-size, size);
      const double swing = field_between(-size, size);
      const double rate = field_between(2.0, 80.0);
      text += axis > 0 ? ", " : "";
      text += field_between(0.0, 1.0) < 0.3
                  ? fmt::format("{:.4g}", middle)
                  : fmt::format("\"{:.4g} + {:.4g} * sin({:.4g} * time_s)\"", middle, swing, rate);
    }
    return text + "]";
  }

  /// Formulas that ask for signals, up to this size. Half of them ask for none of motion.
  std::string asking_field(double size) {
    const bool of_motion = asking_.chance(0.5);
    std::string text = "[";
    for (int axis = 0; axis < space_; ++axis) {
      const double most = asking_.between(-size, size);
      const std::string formula = random_asking_formula(asking_, of_motion);
      text += fmt::format("{}\"{:.4g} * {}\"", axis > 0 ? ", " : "", most, formula);
    }
    return text + "]";
  }

  /// In this share of the cases matter starts by formulas of number and place.
  std::string perhaps_start_by_formula(double share) {
    return starts_.chance(share) ? random_start(starts_, space_) : "";
  }

  void write_masses() {
    const double speed = chance(0.3) ? 0.0 : decades(0.01, 1.0);
    const double one_mass = decades(0.001, 0.1);
    std::string places;
    std::string weights;
    std::string speeds;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const char* comma = i > 0 ? ", " : "";
      places += comma + place(0.15);
      weights += fmt::format("{}{:.4g}", comma,
                             matter_ == Matter::kModes ? one_mass : decades(0.001, 0.1));
      speeds += comma + place(speed);
    }
    masses_ =
        fmt::format("  wall: {{kind: fixed, at_m: {}, ball: {{radius_m: 0.05}}}}\n", place(0.2));
    std::string start = perhaps_start_by_formula(0.08);
    if (start.find("velocity_m_per_s") == std::string::npos)
      start += fmt::format(", velocity_m_per_s: [{}]", speeds);
    masses_ += fmt::format("  p: {{kind: points, at_m: [{}], mass_kg: [{}]{}, radius_m: {:.4g}}}\n",
                           places, weights, start, between(0.02, 0.1));
  }

  double drive_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_drives_()) / 4294967296.0;
  }

  /// A formula of time for each axis, or a table, 0 at 0 s, of about this size.
  std::string function_of_time(double size) {
    const bool is_table = drive_between(0.0, 1.0) < 0.3;
    std::string values;
    for (int row = 0; row < (is_table ? 4 : 1); ++row) {
      values += row > 0 ? ", [" : "[";
      for (int axis = 0; axis < space_; ++axis) {
        const double share = size * drive_between(-1.0, 1.0);
        const double rate = drive_between(2.0, 80.0);
        const std::string comma = axis > 0 ? ", " : "";
        values += is_table ? fmt::format("{}{:.5g}", comma, row == 0 ? 0.0 : share)
                           : fmt::format("{}\"{:.5g} * sin({:.5g} * time_s)\"", comma, share, rate);
      }
      values += "]";
    }
    if (!is_table) return values;
    const bool is_smooth = drive_between(0.0, 1.0) < 0.5;
    return fmt::format("{{at_s: [0.001, 0.02, 0.05, 0.09], values: [{}], between: {}}}", values,
                       is_smooth ? "smooth" : "linear");
  }

  /// Shakes the wall, or pushes the masses.
  void drive_some() {
    const double choice = drive_between(0.0, 1.0);
    if (choice < 0.15) {
      const std::string motion = function_of_time(0.02);
      const std::string end = "0.05}}";
      masses_.insert(masses_.find(end) + end.size() - 1,
                     ", driven: {displacement_m: " + motion + "}");
    } else if (choice < 0.25) {
      masses_.insert(masses_.size() - 2, ", driven: {force_n: " + function_of_time(0.05) + "}");
    }
  }

  /// In a tenth of the scenes a MAT goes along a function of time. A mass hangs on it, or it touches all.
  void perhaps_lead_a_mass() {
    if (!leads_.chance(0.1)) return;
    const std::string drive = random_drive_of_position(leads_, space_, 0.2);
    const double stiffness = leads_.decades(1.0, 1000.0);
    masses_ += fmt::format("  led: {{kind: {}, ball: {{radius_m: 0.03}}{}}}\n",
                           leads_.chance(0.7) ? "fixed" : "mass", drive);
    if (matter_ == Matter::kModes || leads_.chance(0.5)) {
      liaisons_ += fmt::format(
          "  leads: {{kind: spring_damper, stiffness_n_per_m: {0:.4g}, viscosity_n_s_per_m: "
          "{1:.4g}}}\n",
          stiffness, 1e-5 * stiffness);
      links_ += "  - {liaison: leads, between: [led, \"p[0]\"]}\n";
      return;
    }
    liaisons_ += fmt::format("  leads: {{stiffness_n_per_m: {:.4g}, pulls: false}}\n", stiffness);
    links_ += "  - {liaison: leads, between_sets: [led, p], rest_m: 0.1, range_m: 0.1}\n";
  }

  double place_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_places_()) / 4294967296.0;
  }

  /// Along an axis, of a well, a centre, a whirl, waves, a drag or a motor that follows a signal.
  std::string force_by_place(std::uint32_t kind, int axis, double size) const {
    const char name = "xyz"[axis];
    const std::string square = space_ == 1   ? "x_m^2"
                               : space_ == 2 ? "x_m^2 + y_m^2"
                                             : "x_m^2 + y_m^2 + z_m^2";
    switch (kind) {
      case 0:
        return fmt::format("-{:.4g} * {}_m", 30.0 * size, name);
      case 1:
        return fmt::format("-{0:.4g} * {1}_m - {2:.4g} * velocity_{1}_m_per_s", 30.0 * size, name,
                           0.1 * size);
      case 2:
        return fmt::format("-{:.4g} * {}_m / ({} + 0.01)^1.5", 0.01 * size, name, square);
      case 3:
        return axis > 1 ? "0"
                        : fmt::format("{}{:.4g} * {}_m", axis == 0 ? "" : "-", size,
                                      space_ == 1 ? 'x' : "yx"[axis]);
      case 4:
        return fmt::format("{:.4g} * sin(40 * {}_m)", 0.1 * size, name);
      case 5:
        return fmt::format("-{:.4g} * {}_m^3", 1000.0 * size, name);
      case 6:
        return fmt::format("-{0:.4g} * velocity_{1}_m_per_s * abs(velocity_{1}_m_per_s)",
                           0.1 * size, name);
      default:
        return axis == 0 ? fmt::format("{:.4g} * (middle - x_m)", 10.0 * size) : "0";
    }
  }

  /// A tenth of the matter is pushed by where it is, or how fast.
  void perhaps_push_by_place() {
    const double choice = place_between(0.0, 1.0);
    const std::uint32_t kind = random_of_places_() % 8;
    const double size = 0.01 * std::pow(100.0, place_between(0.0, 1.0));
    if (choice > 0.1 || masses_.find("force_n", masses_.find("  p: ")) != std::string::npos) return;
    std::string forces;
    for (int axis = 0; axis < space_; ++axis)
      forces += (axis > 0 ? ", \"" : "\"") + force_by_place(kind, axis, size) + "\"";
    masses_.insert(masses_.size() - 2, ", driven: {force_n: [" + forces + "]}");
  }

  double medium_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_media_()) / 4294967296.0;
  }

  /// A fifth of the matter has a viscosity of the medium of its own, 0 too.
  void perhaps_in_a_medium() {
    const double choice = medium_between(0.0, 1.0);
    const double viscosity = 1e-4 * std::pow(3000.0, medium_between(0.0, 1.0));
    if (choice > 0.2) return;
    has_no_medium_ = choice < 0.03;
    masses_.insert(masses_.size() - 2, fmt::format(", medium_viscosity_n_s_per_m: {:.4g}",
                                                   has_no_medium_ ? 0.0 : viscosity));
  }

  /// A tenth of the bodies has a port at its centre of mass.
  void perhaps_hold_the_body() {
    if (matter_ == Matter::kModes || medium_between(0.0, 1.0) > 0.1) return;
    port_ += fmt::format("  body: {{device: fingers, axes: [0], role: liaison, of: p{}}}\n",
                         space_ > 1 ? ", along: y" : "");
  }

  void write_port() {
    if (matter_ == Matter::kModes || !chance(0.25)) return;
    const bool gives_forces = matter_ == Matter::kPotentials || chance(0.4);
    has_port_ = true;
    std::string more = gives_forces ? ", mass_kg: 0.05" : "";
    if (!gives_forces && chance(0.4)) more = ", coupling: direct";
    if (!gives_forces && more.empty() && chance(0.5)) {
      const double z = decades(0.1, 3);
      more = fmt::format(
          ", coupling: {{stiffness_n_per_m: {:.4g}, viscosity_n_s_per_m: {:.4g}, mass_kg: 0.03}}",
          decades(50, 1000), z);
    }
    port_ = fmt::format(
        "  hand: {{device: hand, axes: [0], role: {}, at_m: {}{}{}, ball: {{radius_m: 0.02}}}}\n",
        gives_forces ? "liaison" : "mass", place(0.1), space_ > 1 ? ", along: x" : "", more);
  }

  /// The name of a MAT, another than this one.
  std::string mat_but(const std::string& other) {
    for (;;) {
      const std::uint32_t which = below(count_ + (has_port_ ? 2 : 1));
      std::string name = which < count_    ? fmt::format("p[{}]", which)
                         : which == count_ ? "wall"
                                           : "hand";
      if (name != other) return name;
    }
  }

  double stiffness() { return decades(0.5, 3000.0); }
  double viscosity() { return chance(0.4) ? decades(1e-4, 3.0) : 0.0; }

  std::string expression(bool viscous) {
    const auto term = [&]() -> std::string {
      switch (below(viscous ? 3 : 9)) {
        case 0:
          return viscous ? fmt::format("{:.4g} * speed_m_per_s", decades(1e-4, 0.5))
                         : fmt::format("{:.4g} * elongation_m", stiffness());
        case 1: {
          const double width = viscous ? decades(0.5, 30.0) : decades(1.0, 50.0);
          const double height = viscous ? decades(1e-3, 1.0) : decades(0.01, 10);
          return fmt::format("{:.4g} * tanh({:.4g} * {})", height, width,
                             viscous ? "speed_m_per_s" : "elongation_m");
        }
        case 2:
          return viscous ? fmt::format("{:.4g} * mass_a_kg * speed_m_per_s", decades(0.01, 3.0))
                         : fmt::format("{:.4g} * elongation_m^3", decades(10.0, 1e5));
        case 3: {
          const double when_shorter = stiffness();
          return fmt::format("if(elongation_m > 0, {:.4g}, {:.4g}) * elongation_m", stiffness(),
                             when_shorter);
        }
        case 4: {
          const double wave_number = decades(3, 60);
          return fmt::format("{:.4g} * sin({:.4g} * distance_m)", between(-2, 2), wave_number);
        }
        case 5: {
          const double decay = decades(3, 60);
          return fmt::format("-{:.4g} * exp(-{:.4g} * distance_m)", decades(0.01, 3.0), decay);
        }
        case 6:
          return fmt::format("{:.4g} * mass_a_kg * mass_b_kg / max(distance_m, 0.01)^2",
                             decades(0.01, 10.0));
        case 7:
          return fmt::format("{:.4g} * speed_m_per_s", decades(1e-4, 0.5));
        default: {
          const double k = stiffness();
          return fmt::format("-max({:.4g} - distance_m, 0) * {:.4g}", between(0.02, 0.2), k);
        }
      }
    };
    std::string text = term();
    for (std::uint32_t more = below(3); more > 0; --more) text += " + " + term();
    return "\"" + text + "\"";
  }

  std::string elasticity(bool potential) {
    switch (below(potential ? 4 : 6)) {
      case 0: {
        const double right = between(0.02, 0.2);
        const double left = between(0.02, 0.2);
        const double at_right = decades(0.01, 30);
        const double at_left = potential || chance(0.9) ? -decades(0.01, 30) : 1.0;
        return fmt::format(
            "{{kind: table, at_m: [{:.4g}, 0, {:.4g}], force_n: [{:.4g}, 0, {:.4g}]}}", -left,
            right, at_left, at_right);
      }
      case 1: {
        const double exponent = 0.5 * (potential ? 2 + below(7) : 1 + below(8));
        const double sign = chance(0.95) ? 1.0 : -1.0;
        return fmt::format("{{kind: power, coefficient: {:.4g}, exponent: {}}}",
                           sign * decades(1.0, 1e4), exponent);
      }
      case 2: {
        const double diameter = between(0.05, 0.2);
        const double cut = diameter * between(1.2, 3.0);
        return fmt::format(
            "{{kind: lennard_jones, depth_j: {:.4g}, diameter_m: {:.4g}, cut_m: {:.4g}}}",
            decades(1e-6, 1e-2), diameter, cut);
      }
      case 3: {
        const double outer_radius = between(0.15, 0.4);
        const double sign = chance(0.3) ? -1.0 : 1.0;
        const double outer = sign * decades(0.1, 100.0);
        const double inner_radius = between(0.05, 0.15);
        return fmt::format(
            "{{kind: rings, rings: [{{stiffness_n_per_m: {:.4g}, radius_m: {:.4g}}}, "
            "{{stiffness_n_per_m: {:.4g}, radius_m: {:.4g}}}]}}",
            stiffness(), inner_radius, outer, outer_radius);
      }
      default:
        return expression(false);
    }
  }

  std::string dissipation() {
    switch (below(3)) {
      case 0: {
        const double slow = decades(0.001, 1.0);
        return fmt::format(
            "{{kind: table, at_m_per_s: [-1, -0.1, 0, 0.1, 1], force_n: [-{0:.4g}, -{1:.4g}, 0, "
            "{1:.4g}, "
            "{0:.4g}]}}",
            decades(0.01, 1.0), slow);
      }
      case 1: {
        const double exponent = one_of({0.5, 1.0, 1.5, 2.0, 3.0});
        return fmt::format("{{kind: power, coefficient: {:.4g}, exponent: {}}}",
                           decades(0.001, 1.0), exponent);
      }
      default:
        return expression(true);
    }
  }

  /// The keys of a state, without braces.
  std::string state() {
    const bool potential = matter_ == Matter::kPotentials;
    std::string text;
    const auto add = [&text](const std::string& key) { text += (text.empty() ? "" : ", ") + key; };
    const bool law = chance(0.5);
    if (!law || chance(0.5)) add(fmt::format("stiffness_n_per_m: {:.4g}", stiffness()));
    if (law) add("elasticity: " + elasticity(potential));
    if (potential) return text;
    const double z = viscosity();
    if (z > 0.0) add(fmt::format("viscosity_n_s_per_m: {:.4g}", z));
    if (chance(0.15)) add("dissipation: " + dissipation());
    if (chance(0.25)) add(chance(0.7) ? "pulls: false" : "pushes: false");
    if (chance(0.1)) add(fmt::format("force_limit_n: {:.4g}", decades(0.01, 10.0)));
    return text;
  }

  std::string condition() {
    const double length = between(-0.05, 0.2);
    const double speed = decades(0.01, 2.0);
    switch (below(14)) {
      case 0:
        return fmt::format("elongation_m > {:.4g}", length);
      case 1:
        return fmt::format("elongation_m < {:.4g}", -length);
      case 2:
        return fmt::format("distance_m < {:.4g}", std::abs(length));
      case 3:
        return fmt::format("abs(elongation_m) > {:.4g} * rest_m", decades(0.1, 3.0));
      case 4:
        return fmt::format("speed_m_per_s < -{:.4g}", speed);
      case 5:
        return fmt::format("abs(speed_m_per_s) < {:.4g} and falling(abs(speed_m_per_s))", speed);
      case 6:
        return fmt::format("force_n > {:.4g}", decades(0.01, 10.0));
      case 7:
        return fmt::format("abs(force_n) < {:.4g}", decades(0.01, 1.0));
      case 8:
        return fmt::format("impulse_n_s > {:.4g}", decades(1e-4, 0.1));
      case 9:
        return fmt::format("age_s > {:.4g}", decades(1e-3, 1.0));
      case 10:
        return fmt::format("rising(elongation_m) and elongation_m > {:.4g}", length);
      case 11:
        return fmt::format("mass_a_kg < {:.4g} and age_s > 0.01", decades(0.001, 0.1));
      case 12:
        return space_ > 1 ? fmt::format("slip_m_per_s > {:.4g}", speed)
                          : fmt::format("speed_x_m_per_s > {:.4g}", speed);
      default:
        return fmt::format("not (distance_m > {:.4g} or speed_m_per_s > 0)", std::abs(length));
    }
  }

  double variable_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_variables_()) / 4294967296.0;
  }

  /// Adds what conditions of later links may ask a link for.
  void add_asked(const std::string& link, std::initializer_list<const char*> words) {
    links_to_ask_.emplace_back();
    for (const char* word : words) links_to_ask_.back().push_back(link + "." + word);
  }

  /// A condition over another link or a bend; in half of the cases none.
  std::string asked_of_links() {
    if (links_to_ask_.empty() || links_asked_.chance(0.4)) return {};
    const auto& words =
        links_to_ask_[links_asked_.below(static_cast<std::uint32_t>(links_to_ask_.size()))];
    const std::string& word = words[links_asked_.below(static_cast<std::uint32_t>(words.size()))];
    const double limit = links_asked_.decades(0.003, 1.0);
    return links_asked_.chance(0.5) ? fmt::format("abs({}) > {:.4g}", word, limit)
                                    : fmt::format("{} < {:.4g}", word, limit);
  }

  /// A condition over something outside the link: time, a MAT, a port, another link, a signal.
  std::string asked_outside() {
    if (std::string asked = asked_of_links(); !asked.empty()) return asked;
    const std::string mat = fmt::format("p[{}]", random_of_variables_() % count_);
    const std::string more = variable_between(0.0, 1.0) < 0.5 ? ">" : "<";
    const double length = variable_between(-0.15, 0.15);
    const double speed = 0.01 * std::pow(100.0, variable_between(0.0, 1.0));
    switch (random_of_variables_() % 8) {
      case 0:
        return fmt::format("time_s {} {:.4g}", more, variable_between(0.0, 0.5));
      case 1:
        return fmt::format("{}.position_x_m {} {:.4g}", mat, more, length);
      case 2:
        return fmt::format("{}.speed_m_per_s {} {:.4g} and rising({}.velocity_x_m_per_s)", mat,
                           more, speed, mat);
      case 3:
        return fmt::format("wall.position_x_m {} {:.4g}", more, length);
      case 4:
        if (has_port_) return fmt::format("hand.position_m {} {:.4g}", more, 0.1 * length);
        [[fallthrough]];
      case 5:
        if (links_with_states_ > 0) {
          const std::string link = fmt::format("s{}", random_of_variables_() % links_with_states_);
          return fmt::format("{}.state == s1 and {}.age_s > {:.4g} or {}.force_n {} {:.4g}", link,
                             link, 0.1 * std::abs(length), link, more, speed);
        }
        [[fallthrough]];
      case 6:
        return fmt::format("{}.force_x_n {} {:.4g}", mat, more, 10.0 * length);
      default:
        switch (random_of_media_() % 3) {  // a signal: of the scene, of a body, of many values
          case 0:
            return fmt::format("lively {} {:.4g}", more, 1e-3 * speed);
          case 1:
            return fmt::format("middle {} {:.4g}", more, length);
          default:
            return fmt::format("fastest {} {:.4g}", more, speed);
        }
    }
  }

  /// A fifth of the conditions ask outside their link. Their numbers come from a source of their own.
  std::string perhaps_asking_outside(const std::string& condition) {
    if (variable_between(0.0, 1.0) > 0.2) return condition;
    const std::string asked = asked_outside();
    const double choice = variable_between(0.0, 1.0);
    if (choice < 0.4) return asked;
    return fmt::format("({}) {} ({})", condition, choice < 0.7 ? "and" : "or", asked);
  }

  std::string exit(const std::string& target) {
    const std::string rest =
        one_of<const char*>({"", "", ", rest: here", ", rest: \"0.5 * (rest_m + distance_m)\""});
    return fmt::format("{{to: {}, when: \"{}\"{}}}", target, perhaps_asking_outside(condition()),
                       rest);
  }

  /// A liaison in braces.
  std::string liaison() {
    if (matter_ == Matter::kModes) {
      const double k = stiffness();
      return fmt::format(
          "{{kind: spring_damper, stiffness_n_per_m: {:.4g}, viscosity_n_s_per_m: {:.4g}}}", k,
          1e-5 * k);
    }
    if (matter_ == Matter::kPotentials) {
      return chance(0.4) ? fmt::format("{{kind: spring, stiffness_n_per_m: {:.4g}}}", stiffness())
                         : one_state();
    }
    switch (below(10)) {
      case 0:
        return fmt::format("{{kind: spring, stiffness_n_per_m: {:.4g}}}", stiffness());
      case 1:
        return fmt::format("{{kind: damper, viscosity_n_s_per_m: {:.4g}}}", decades(1e-3, 10.0));
      case 2:
        return spring_and_damper("spring_damper");
      case 3:
        return spring_and_damper("maxwell");
      case 4:
      case 5:
      case 6:
        return one_state();
      default:
        return state_machine();
    }
  }

  std::string spring_and_damper(const char* kind) {
    const double z = decades(1e-3, 10.0);
    return fmt::format("{{kind: {}, stiffness_n_per_m: {:.4g}, viscosity_n_s_per_m: {:.4g}}}", kind,
                       stiffness(), z);
  }

  std::string one_state() { return "{kind: state_machine, " + state() + "}"; }

  std::string state_machine() {
    const std::uint32_t states = 2 + below(2);
    std::string text = "{states: {";
    for (std::uint32_t s = 0; s < states; ++s) {
      text += fmt::format("{}s{}: {{{}", s > 0 ? ", " : "", s, chance(0.15) ? "" : state());
      if (text.back() != '{') text += ", ";
      text += "exits: [" + exit(fmt::format("s{}", (s + 1) % states));
      if (states > 2 && chance(0.3)) text += ", " + exit(fmt::format("s{}", (s + 2) % states));
      text += "]}";
    }
    return text + "}}";
  }

  void add_link(std::uint32_t l) {
    const std::string law = liaison();
    liaisons_ += fmt::format("  l{}: {}\n", l, law);
    const std::string a = mat_but("");
    std::string more;
    // Half of all keep the distance of the start.
    const bool has_rest =
        liaisons_.find(fmt::format("l{}: {{kind: maxwell", l)) == std::string::npos &&
        liaisons_.find(fmt::format("l{}: {{kind: damper", l)) == std::string::npos;
    if (has_rest && chance(0.5)) {
      more = fmt::format(", rest_m: {:.4g}", space_ == 1 ? between(-0.2, 0.3) : between(0.0, 0.3));
    }
    std::string name = fmt::format("l{}", l);  // of the liaison: that of a link without one
    if (law.find("states:") != std::string::npos) {
      name = fmt::format("s{}", links_with_states_++);
      more += ", name: " + name;
      add_asked(name, {"distance_m", "elongation_m", "force_n", "rest_length_m", "age_s"});
    } else if (law.find("maxwell") != std::string::npos) {
      name = fmt::format("m{}", l);
      more += ", name: " + name;
      add_asked(name, {"distance_m", "speed_m_per_s"});
    } else {
      add_asked(name, {"distance_m", "elongation_m", "speed_m_per_s", "force_n"});
    }
    links_ +=
        fmt::format("  - {{liaison: l{}, between: [\"{}\", \"{}\"]{}}}\n", l, a, mat_but(a), more);
  }

  /// Half of the liaisons of sets rub where they may. Its numbers come from a source of their own: so what
  /// else a seed writes stays as it was.
  std::string perhaps_rubbing(const std::string& law) {
    if (!may_rub_ || friction_random_() % 2 == 0) return law;
    const auto chosen = [this](double low, double high) {
      const double share = static_cast<double>(friction_random_()) / 4294967296.0;
      return low * std::pow(high / low, share);
    };
    const double most = chosen(0.05, 1.5);
    const double kinetic = chosen(0.3, 1.0) * most;
    const double k = chosen(0.1, 3000.0);
    const double z = friction_random_() % 3 == 0 ? 0.0 : chosen(1e-3, 1.0);
    std::string text = with_friction_of_states(law, k);
    text.pop_back();
    return text + fmt::format(
                      ", friction: {{static: {:.4g}, kinetic: {:.3g}, stiffness_n_per_m: {:.4g}, "
                      "viscosity_n_s_per_m: {:.4g}}}}}",
                      most, 0.99 * kinetic, k, z);
  }

  /// Gives some states another friction, or none, and some exits a condition that asks for it. One state
  /// rubs at least, for a scene that asks for the `slip_m` of what never rubs is refused.
  std::string with_friction_of_states(std::string law, double stiffness) {
    const std::string opening = "exits: [";
    const std::string none = "friction: none, ";
    bool may_rub = law.find(opening) == std::string::npos;
    for (std::size_t exits = law.find(opening); exits != std::string::npos;) {
      const double size = static_cast<double>(friction_random_() % 1000 + 1) / 1000.0;
      std::string own;
      if (friction_random_() % 3 == 0) {
        own =
            friction_random_() % 3 == 0
                ? none
                : fmt::format(
                      "friction: {{static: {:.4g}, kinetic: {:.3g}, stiffness_n_per_m: {:.4g}}}, ",
                      size, 0.5 * size, (0.2 + 3.0 * size) * stiffness);
      }
      std::string more;
      if (friction_random_() % 3 == 0) {
        const std::size_t target = law.find("to: ", exits);
        more = fmt::format(
            "{{{}, when: {} > {:.4g}}}, ", law.substr(target, law.find(',', target) - target),
            friction_random_() % 2 == 0 ? "slip_m" : "0.001 * normal_force_n", 0.01 * size * size);
      }
      may_rub = may_rub || own != none;
      law.insert(exits + opening.size(), more);
      law.insert(exits, own);
      exits = law.find(opening, exits + own.size() + opening.size());
    }
    if (!may_rub) law.erase(law.find(none), none.size());
    return law;
  }

  double bend_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_bends_()) / 4294967296.0;
  }

  /// Between neighbours and at the wall, in four scenes of ten; its numbers have a source of their own too.
  void add_bends() {
    if (bend_between(0.0, 1.0) > 0.4) return;
    const auto chosen = [this](double low, double high) {
      return low * std::pow(high / low, bend_between(0.0, 1.0));
    };
    const double stiffness = chosen(1e-4, 1.0);
    std::string law = fmt::format("{{kind: bending, stiffness_n_m_per_rad: {:.4g}", stiffness);
    const double length = chosen(0.03, 0.3);
    if (space_ == 1 || bend_between(0.0, 1.0) < 0.3)
      law += fmt::format(", length_m: {:.4g}", length);
    const double viscosity = chosen(1e-6, 1e-2);
    if (matter_ == Matter::kAnything && bend_between(0.0, 1.0) < 0.6)
      law += fmt::format(", viscosity_n_m_s_per_rad: {:.4g}", viscosity);
    const double rest = bend_between(-3.0, 3.0);
    if (space_ < 3 && bend_between(0.0, 1.0) < 0.5) law += fmt::format(", rest_rad: {:.4g}", rest);
    law += law_of_bend(stiffness);
    if (matter_ == Matter::kAnything && bend_between(0.0, 1.0) < 0.6) {
      law = bend_with_states(stiffness);
      if (space_ == 1 || bend_between(0.0, 1.0) < 0.3)
        law += fmt::format(", length_m: {:.4g}", length);
    }
    liaisons_ += "  of_bends: " + law + "}\n";
    if (count_ > 2 && bend_between(0.0, 1.0) < 0.7) links_ += "  - {liaison: of_bends, along: p}\n";
    links_ += "  - {liaison: of_bends, between: [wall, \"p[0]\", \"p[1]\"]}\n";
    if (law.find("states:") != std::string::npos) {
      add_asked("of_bends[0]", {"angle_rad", "bend_rad", "rest_angle_rad", "moment_n_m", "age_s"});
    } else {
      add_asked("of_bends[0]", {"angle_rad", "bend_rad", "speed_rad_per_s", "moment_n_m"});
    }
  }

  /// A bend that yields, and snaps or comes back.
  std::string bend_with_states(double stiffness) {
    const std::string viscosity =
        bend_between(0.0, 1.0) < 0.5
            ? fmt::format(", viscosity_n_m_s_per_rad: {:.4g}", bend_between(1e-6, 1e-3))
            : "";
    const std::string own_rest = space_ < 3 && bend_between(0.0, 1.0) < 0.3
                                     ? fmt::format(", rest_rad: {:.4g}", bend_between(-1.0, 1.0))
                                     : "";
    const std::string fold = space_ == 3                    ? ""
                             : bend_between(0.0, 1.0) < 0.5 ? ", rest: here"
                                                            : ", rest: rest_rad + 0.5 * bend_rad";
    const double yield = bend_between(0.02, 1.0);
    const double softer = stiffness * bend_between(0.05, 1.2);
    const std::string asked = perhaps_asking_outside(fmt::format("abs(bend_rad) > {:.4g}", yield));
    return fmt::format(
        "{{kind: bending, states: {{"
        "whole: {{stiffness_n_m_per_rad: {:.4g}{}{}, exits: [{{to: bent, when: \"{}\"{}}}]}}, "
        "bent: {{stiffness_n_m_per_rad: {:.4g}{}, exits: ["
        "{{to: cut, when: abs(angle_rad) > {:.4g} or moment_n_m > {:.4g}}}, "
        "{{to: whole, when: \"age_s > {:.4g} and falling(speed_rad_per_s)\"}}]}}, "
        "cut: {{final: true}}}}",
        stiffness, viscosity, own_rest, asked, fold, softer, law_of_bend(softer),
        yield + bend_between(0.05, 2.0), softer, bend_between(0.001, 0.1));
  }

  double law_of_bend_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_laws_of_bends_()) / 4294967296.0;
  }

  /// Laws beside the stiffness of a bend, in half of the cases: they act alike both ways.
  std::string law_of_bend(double stiffness) {
    if (matter_ != Matter::kAnything || law_of_bend_between(0.0, 1.0) < 0.5) return "";
    const double slope = stiffness * law_of_bend_between(0.1, 2.0);
    const double more = stiffness * law_of_bend_between(0.1, 5.0);
    const double width = law_of_bend_between(0.1, 2.0);
    const double drag = stiffness * std::pow(10.0, law_of_bend_between(-5.0, -2.0));
    std::string law;
    switch (static_cast<int>(law_of_bend_between(0.0, 7.0))) {
      case 0:
        law = fmt::format("\"{:.4g} * bend_rad + {:.4g} * bend_rad^3\"", slope, more);
        break;
      case 1:
        law = fmt::format("{:.4g} * sin(bend_rad)", slope);
        break;
      case 2:
        law = fmt::format("{:.4g} * tanh(bend_rad / {:.4g})", slope * width, width);
        break;
      case 3:
        law = fmt::format(
            "{{kind: table, at_rad: [{:.4g}, 0, {:.4g}], moment_n_m: [{:.4g}, 0, {:.4g}]}}", -width,
            width, -slope * width, slope * width);
        break;
      case 4:
        law = fmt::format("{{kind: power, coefficient: {:.4g}, exponent: {}}}", slope,
                          1.0 + 0.5 * std::floor(law_of_bend_between(0.0, 5.0)));
        break;
      case 5:
        law = fmt::format("{:.4g} * bend_rad + {:.4g} * speed_rad_per_s * abs(bend_rad)", slope,
                          drag);
        break;
      default:
        law = fmt::format("\"{:.4g} * (1 + 0.5 * sin({:.4g} * time_s)) * bend_rad\"", slope,
                          law_of_bend_between(1.0, 50.0));
        break;
    }
    law = ", elasticity: " + law;
    if (law_of_bend_between(0.0, 1.0) < 0.3)
      law += fmt::format(", dissipation: {{kind: power, coefficient: {:.4g}, exponent: {}}}", drag,
                         law_of_bend_between(0.0, 1.0) < 0.5 ? 1 : 2);
    return law;
  }

  double lively_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_lively_laws_()) / 4294967296.0;
  }
  double lively_decades(double low, double high) {
    return low * std::pow(high / low, lively_between(0.0, 1.0));
  }

  /// Viscosity that grows with the speed, beside a spring that is far stretched.
  std::string fast_law() {
    const double stiffness = lively_decades(10.0, 3000.0);
    const double exponent = lively_between(0.0, 1.0) < 0.5 ? 2.0 : 3.0;
    const double coefficient = lively_decades(0.01, 20.0);
    const std::string law = lively_between(0.0, 1.0) < 0.8
                                ? fmt::format("{{kind: power, coefficient: {:.4g}, exponent: {}}}",
                                              coefficient, exponent)
                                : fmt::format("\"{:.4g} * speed_m_per_s^3\"", coefficient);
    return fmt::format("stiffness_n_per_m: {:.4g}, dissipation: {}", stiffness, law);
  }

  /// A law that drives the motion, beside a spring.
  std::string driving_law() {
    const double stiffness = lively_decades(0.5, 300.0);
    const double size = lively_decades(0.001, 0.3);
    const std::string spring = fmt::format("stiffness_n_per_m: {:.4g}, ", stiffness);
    switch (random_of_lively_laws_() % 4) {
      case 0:
        return spring + fmt::format("dissipation: \"-{:.4g} * speed_m_per_s\"", size);
      case 1:
        return spring +
               fmt::format("dissipation: {{kind: power, coefficient: -{:.4g}, exponent: 2}}", size);
      case 2:
        return spring + fmt::format(
                            "dissipation: {{kind: table, at_m_per_s: [-1, 0, 1], force_n: "
                            "[{0:.4g}, 0, -{0:.4g}]}}",
                            size);
      default:
        return fmt::format("elasticity: \"{:.4g} * elongation_m - {:.4g} * speed_m_per_s\"",
                           stiffness, size);
    }
  }

  /// A law whose potential falls without an end.
  std::string falling_law() {
    const double force = (lively_between(0.0, 1.0) < 0.5 ? -1.0 : 1.0) * lively_decades(0.1, 30.0);
    switch (random_of_lively_laws_() % 3) {
      case 0:
        return fmt::format(
            "elasticity: {{kind: table, at_m: [-1, 1], force_n: [{0:.4g}, {0:.4g}]}}", force);
      case 1:
        return fmt::format("elasticity: \"{:.4g} - 0 * elongation_m\"", force);
      default:
        return fmt::format("elasticity: \"-{:.4g} * elongation_m\"", std::abs(force));
    }
  }

  /// In a fifth of the scenes a law that is lively, and perhaps one that only the energy confines.
  void perhaps_add_lively_law() {
    const double choice = lively_between(0.0, 1.0);
    if (choice > 0.2) return;
    const std::string law = choice < 0.1    ? fast_law()
                            : choice < 0.15 ? driving_law()
                                            : falling_law();
    liaisons_ += "  lively: {kind: state_machine, " + law + "}\n";
    links_ += fmt::format("  - {{liaison: lively, between: [wall, \"p[0]\"], rest_m: {:.4g}}}\n",
                          lively_between(0.1, 0.6));
    if (choice < 0.1 || lively_between(0.0, 1.0) < 0.3) return;
    liaisons_ += fmt::format(
        "  confines: {{kind: state_machine, elasticity: {{kind: power, coefficient: {:.4g}, "
        "exponent: 3}}}}\n",
        lively_decades(100.0, 1e5));
    links_ += "  - {liaison: confines, between: [wall, \"p[0]\"], rest_m: 0.1}\n";
  }

  /// A number about 1 that changes, above 0 or not.
  std::string changing_number() { return changing_number(random_of_parameters_); }

  static std::string changing_number(std::mt19937& random) {
    const auto between = [&random](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    const double swing = between(-0.9, 0.9);
    const double rate = std::pow(10.0, between(0.0, 3.0));
    switch (random() % 7) {
      case 0:
      case 1:
        return fmt::format("(1 + {:.3g} * sin({:.4g} * time_s))", swing, rate);
      case 2:
        return fmt::format("(1 - {:.3g} * exp(-{:.4g} * time_s))", swing, rate);
      case 3:
        return fmt::format("(1 + {:.3g} * min({:.4g} * time_s, 1))", swing, rate);
      case 4:
        return fmt::format("(1 + {:.3g} * tanh({:.4g} * middle))", swing, rate);
      case 5:
        return fmt::format("(1 - {:.3g} * min(fastest, 1))", swing);
      default:
        return fmt::format("(1 + {:.3g} * middle)", swing);
    }
  }

  /// In an eighth of the scenes a link whose parameters follow time or signals.
  void perhaps_add_changing_link() {
    const auto number = [this] {
      return static_cast<double>(random_of_parameters_()) / 4294967296.0;
    };
    if (number() > 0.125) return;
    const double stiffness = 5.0 * std::pow(600.0, number());
    std::string keys =
        fmt::format("stiffness_n_per_m: \"{:.4g} * {}\"", stiffness, changing_number());
    std::string kind = "spring";
    if (number() < 0.6) {
      kind = "spring_damper";
      keys += fmt::format(", viscosity_n_s_per_m: \"{:.4g} * {}\"", std::pow(1e4, number() - 0.8),
                          changing_number());
    }
    if (number() < 0.4) {
      keys += fmt::format(", rest_m: \"{:.4g} * {}\"", 0.05 + 0.3 * number(), changing_number());
    }
    liaisons_ += "  changing: {kind: " + kind + ", " + keys + "}\n";
    links_ += "  - {liaison: changing, between: [wall, \"p[0]\"]}\n";
  }

  /// In a sixth of the scenes a Maxwell element, a bend and a liaison of sets whose parameters follow time or
  /// signals, each or not.
  void perhaps_add_formulas() {
    const auto between = [this](double low, double high) {
      return low + (high - low) * static_cast<double>(random_of_formulas_()) / 4294967296.0;
    };
    const auto changing = [this](double number) {
      return fmt::format("\"{:.4g} * {}\"", number, changing_number(random_of_formulas_));
    };
    if (between(0.0, 1.0) > 1.0 / 6.0) return;
    if (between(0.0, 1.0) < 0.6) {
      const double stiffness = 5.0 * std::pow(600.0, between(0.0, 1.0));
      const double viscosity = std::pow(1e4, between(-0.8, 0.2));
      const std::string k = changing(stiffness);
      liaisons_ += fmt::format(
          "  creeps: {{kind: maxwell, stiffness_n_per_m: {}, viscosity_n_s_per_m: {}}}\n", k,
          changing(viscosity));
      links_ += "  - {liaison: creeps, between: [wall, \"p[0]\"]}\n";
    }
    if (between(0.0, 1.0) < 0.6 && !freezes_ && count_ > 1) {
      const double stiffness = std::pow(1e3, between(-1.0, 0.0));
      std::string keys = "stiffness_n_m_per_rad: " + changing(stiffness);
      if (between(0.0, 1.0) < 0.5)
        keys += ", viscosity_n_m_s_per_rad: " + changing(std::pow(1e3, between(-2.0, -1.0)));
      if (between(0.0, 1.0) < 0.5 && space_ < 3) keys += ", rest_rad: " + changing(0.3);
      liaisons_ += "  flexes: {kind: bending, length_m: 0.2, " + keys + "}\n";
      links_ += "  - {liaison: flexes, between: [wall, \"p[0]\", \"p[1]\"]}\n";
    }
    if (between(0.0, 1.0) < 0.7 && count_ > 1) {
      const double stiffness = 5.0 * std::pow(600.0, between(0.0, 1.0));
      std::string keys = "pulls: false, stiffness_n_per_m: " + changing(stiffness);
      if (between(0.0, 1.0) < 0.5)
        keys += ", viscosity_n_s_per_m: " + changing(std::pow(1e4, between(-0.9, 0.0)));
      if (between(0.0, 1.0) < 0.3) keys += fmt::format(", force_limit_n: {:.4g}", 0.02 * stiffness);
      if (may_rub_ && between(0.0, 1.0) < 0.5) {
        keys += fmt::format(", friction: {{static: {}, stiffness_n_per_m: {:.4g}}}",
                            changing(between(0.1, 1.0)), stiffness);
      }
      liaisons_ += "  yields: {" + keys + "}\n";
      links_ += "  - {liaison: yields, within: p, rest_m: 0.1, range_m: 0.1}\n";
    }
  }

  double crowd_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_crowds_()) / 4294967296.0;
  }

  /// A spring, or a law like one, that holds every pair of a crowd at a distance.
  std::string crowd_law(double stiffness, double rest) {
    switch (random_of_crowds_() % 4) {
      case 0:
        return fmt::format("elasticity: {{kind: power, coefficient: {:.4g}, exponent: 1}}",
                           stiffness);
      case 1:
        return fmt::format("elasticity: \"{:.4g} * elongation_m\"", stiffness);
      case 2:
        return fmt::format(
            "elasticity: {{kind: rings, rings: [{{stiffness_n_per_m: {:.4g}, radius_m: {:.4g}}}]}}",
            stiffness, rest);
      default:
        return fmt::format("stiffness_n_per_m: {:.4g}", stiffness);
    }
  }

  /// In a tenth of the scenes masses that are all in range of each other, crumpled or not, without viscosity.
  /// In most of these nothing else acts: what it gains does not hide in other energy.
  void perhaps_add_crowd() {
    const double choice = crowd_between(0.0, 1.0);
    if (choice > 0.1) return;
    if (choice < 0.07) {
      liaisons_.clear();
      links_.clear();
    }
    const auto count = static_cast<std::uint32_t>(2 + random_of_crowds_() % 19);
    const double rest = crowd_between(0.01, 0.05);
    const double half = rest * std::pow(100.0, crowd_between(-1.0, 0.0));
    const double speed = crowd_between(0.0, 1.0) < 0.5 ? 0.0 : crowd_between(0.0, 0.3);
    std::string places;
    std::string speeds;
    for (std::uint32_t i = 0; i < count; ++i) {
      for (auto* list : {&places, &speeds}) {
        *list += i > 0 ? ", " : "";
        if (space_ > 1) *list += "[";
        for (int axis = 0; axis < space_; ++axis) {
          const double most = list == &places ? half : speed;
          *list += fmt::format("{}{:.5g}", axis > 0 ? ", " : "", crowd_between(-most, most));
        }
        if (space_ > 1) *list += "]";
      }
    }
    masses_ += fmt::format(
        "  crowd: {{kind: points, at_m: [{}], mass_kg: 0.002, velocity_m_per_s: [{}]}}\n", places,
        speeds);
    const double stiffness = 10.0 * std::pow(100.0, crowd_between(0.0, 1.0));
    liaisons_ += "  of_crowd: {kind: state_machine, " + crowd_law(stiffness, rest) + "}\n";
    links_ += fmt::format(
        "  - {{liaison: of_crowd, within: crowd, rest_m: {:.4g}, range_m: 100}}\n", rest);
  }

  /// In a twentieth of the scenes a pressed spring shoots a ball at some of Lennard-Jones, light or heavy.
  void perhaps_add_shot() {
    if (!shots_.chance(0.05)) return;
    const double size = shots_.decades(0.05, 1.0);
    const double energy = shots_.decades(1e-3, 10.0);
    const auto place_at = [&](double place) {
      return fmt::format("[{:.5g}{}]", size * place,
                         space_ == 1   ? ""
                         : space_ == 2 ? ", 0"
                                       : ", 0, 0");
    };
    std::string targets = place_at(0.5);
    const std::uint32_t more = shots_.below(3);
    for (std::uint32_t i = 0; i < more; ++i) targets += ", " + place_at(0.62 + 0.12 * i);
    masses_ += fmt::format("  butt: {{kind: fixed, at_m: {}}}\n", place_at(-0.8));
    masses_ += fmt::format("  shot: {{kind: points, mass_kg: {:.4g}, at_m: [{}]}}\n",
                           shots_.decades(1e-3, 0.1), place_at(0.0));
    masses_ += fmt::format("  targets: {{kind: points, mass_kg: {:.4g}, at_m: [{}]}}\n",
                           shots_.decades(1e-3, 10.0), targets);
    const double pressed = 0.2 * size;
    liaisons_ +=
        fmt::format("  of_shot: {{kind: state_machine, stiffness_n_per_m: {:.4g}, pulls: false}}\n",
                    2.0 * energy / (pressed * pressed));
    liaisons_ += fmt::format(
        "  of_targets: {{elasticity: {{kind: lennard_jones, depth_j: {:.4g}, diameter_m: {:.4g}, "
        "cut_m: {:.4g}}}}}\n",
        energy * shots_.decades(1e-4, 1e-1), 0.1 * size, 0.25 * size);
    links_ += fmt::format(
        "  - {{liaison: of_shot, between: [butt, \"shot[0]\"], rest_m: {:.5g}}}\n", size);
    links_ +=
        fmt::format("  - {{liaison: of_targets, between_sets: [shot, targets], range_m: {:.4g}}}\n",
                    0.25 * size);
  }

  double body_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_bodies_()) / 4294967296.0;
  }

  /// A point away from the masses, shifted along the first axis, or nothing in 1 dimension.
  std::string body_point(const char* key, double shift) {
    if (space_ == 1) return {};
    std::string text =
        fmt::format(", {}: [{:.4g}, {:.4g}", key, 0.2 + shift, body_between(0.0, 0.1));
    if (space_ > 2) text += fmt::format(", {:.4g}", body_between(0.0, 0.1));
    return text + "]";
  }

  /// In a tenth of the scenes a string, a net, a crystal, a beam or a pack of balls, of up to 27 MATs, that
  /// touches the masses or hangs on one.
  void perhaps_add_body() {
    const double choice = body_between(0.0, 1.0);
    if (choice > 0.1) return;
    const auto chosen = [this](double low, double high) {
      return low * std::pow(high / low, body_between(0.0, 1.0));
    };
    std::string links = fmt::format(", stiffness_n_per_m: {:.4g}", chosen(5.0, 3000.0));
    const double viscosity = chosen(1e-4, 1.0);
    if (matter_ == Matter::kAnything && body_between(0.0, 1.0) < 0.6)
      links += fmt::format(", viscosity_n_s_per_m: {:.4g}", viscosity);
    const double mass = chosen(0.001, 0.05);
    const std::string punctual = fmt::format(", mass_kg: {:.4g}", mass);
    const auto count = static_cast<int>(body_between(3.0, 8.0));
    const double spacing = body_between(0.02, 0.05);
    const auto kind = random_of_bodies_() % (space_ == 1 ? 1 : 5);
    std::string body;
    if (kind == 0) {
      body = fmt::format("kind: string, count: {}{}{}, ends: {}", count, body_point("from_m", 0.0),
                         body_point("to_m", 0.2), body_between(0.0, 1.0) < 0.5 ? "free" : "fixed");
    } else if (kind == 1) {
      body = space_ == 3 ? fmt::format("kind: grid, rows: 3, columns: {}, spacing_m: {:.4g}{}",
                                       count, spacing, body_point("corner_m", 0.0))
                         : fmt::format("kind: ring, count: {}, radius_m: {:.4g}{}", count, spacing,
                                       body_point("center_m", 0.0));
    } else if (kind == 2) {
      body = fmt::format("kind: lattice, structure: {}, spacing_m: {:.4g}, counts: {}{}",
                         space_ == 3 ? "cubic" : "triangular", spacing,
                         space_ == 3 ? "[3, 2, 2]" : "[3, 3]", body_point("corner_m", 0.0));
    } else if (kind == 3) {
      body = fmt::format("kind: beam, cells: {}{}{}, height_m: {:.4g}", count,
                         body_point("from_m", 0.0), body_point("to_m", 0.3), spacing);
      if (space_ == 3) body += fmt::format(", width_m: {:.4g}", spacing);
    } else {
      const std::string center = body_point("center_m", 0.0);
      masses_ += fmt::format(
          "  more: {{kind: pack, ball: {{mass_kg: {:.4g}, radius_m: 0.01}}, region: {{{}, "
          "radius_m: "
          "0.05}}, count: {}, seed: 1}}\n",
          mass, center.substr(2), count);
      links.clear();
    }
    if (!links.empty())
      masses_ += "  more: {" + body + punctual + links + perhaps_start_by_formula(0.3) + "}\n";
    liaisons_ +=
        fmt::format("  of_body: {{kind: state_machine, stiffness_n_per_m: {:.4g}, pulls: false}}\n",
                    chosen(5.0, 3000.0));
    if (body_between(0.0, 1.0) < 0.5) {
      links_ += fmt::format(
          "  - {{liaison: of_body, between_sets: [p, more], rest_m: {:.4g}, range_m: {:.4g}}}\n",
          0.05, 0.05);
    } else {
      links_ += fmt::format(
          "  - {{liaison: of_body, between: [\"p[0]\", \"more[1]\"], rest_m: {:.4g}}}\n",
          body_between(0.05, 0.3));
    }
    if (links.empty())
      links_ += "  - {liaison: of_body, within: more, rest: radii, range_m: 0.02}\n";
  }

  double shell_between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_of_shells_()) / 4294967296.0;
  }
  double shell_decades(double low, double high) {
    return low * std::pow(high / low, shell_between(0.0, 1.0));
  }

  /// A point in front of the masses.
  std::string shell_point(double x, double y) const {
    return space_ == 2 ? fmt::format("[{:.4g}, {:.4g}]", x, y)
                       : fmt::format("[{:.4g}, {:.4g}, 0.05]", x, y);
  }

  /// Stiffness and perhaps viscosity of the links that matter makes. @param prefix  of the keys
  std::string shell_links(const std::string& prefix) {
    const double stiffness = shell_decades(5.0, 3000.0);
    const double viscosity = shell_decades(1e-4, 1.0);
    const bool is_viscous = matter_ == Matter::kAnything && shell_between(0.0, 1.0) < 0.6;
    std::string text = fmt::format(", {}stiffness_n_per_m: {:.4g}", prefix, stiffness);
    if (is_viscous) text += fmt::format(", {}viscosity_n_s_per_m: {:.4g}", prefix, viscosity);
    return text;
  }

  /// A circle, a polygon or a sphere of 12 or 42 MATs, perhaps braced, perhaps with a core.
  std::string skin() {
    const double radius = shell_between(0.03, 0.1);
    const double x = shell_between(0.15, 0.3);
    const double y = shell_between(-0.1, 0.1);
    std::string text = "kind: skin, ";
    if (space_ == 3) {
      text += fmt::format("center_m: {}, radius_m: {:.4g}, subdivisions: {}", shell_point(x, y),
                          radius, shell_between(0.0, 1.0) < 0.2 ? 1 : 0);
    } else if (shell_between(0.0, 1.0) < 0.6) {
      const auto count = static_cast<int>(shell_between(3.0, 17.0));
      text += fmt::format("center_m: {}, radius_m: {:.4g}, count: {}", shell_point(x, y), radius,
                          count);
    } else {
      const double lean = shell_between(-1.0, 1.0);
      text += fmt::format("corners_m: [{}, {}, {}, {}], spacing_m: {:.4g}", shell_point(x, y),
                          shell_point(x + radius, y + 0.3 * lean * radius),
                          shell_point(x + 1.4 * radius, y + radius), shell_point(x, y + radius),
                          shell_between(0.3, 1.0) * radius);
    }
    text += fmt::format(", mass_kg: {:.4g}", shell_decades(0.001, 0.05)) + shell_links("");
    if (shell_between(0.0, 1.0) < 0.2)
      text += fmt::format(", tension_n: {:.4g}", shell_decades(0.001, 0.1));
    if (shell_between(0.0, 1.0) < 0.5) text += shell_links("shear_");
    if (shell_between(0.0, 1.0) < 0.4) {
      const double mass = shell_decades(0.001, 0.1);
      text += fmt::format(", core: {{mass_kg: {:.4g}{}}}", mass, shell_links(""));
    }
    return text;
  }

  /// A disc of triangles or of rings with its own links, of masses or of balls.
  std::string disc() {
    const double spacing = shell_between(0.02, 0.05);
    const double x = shell_between(0.15, 0.3);
    const double y = shell_between(-0.1, 0.1);
    const double mass = shell_decades(0.001, 0.05);
    const bool of_rings = shell_between(0.0, 1.0) < 0.5;
    const bool of_balls = shell_between(0.0, 1.0) < 0.5;
    const double radius = spacing * (shell_between(1.05, 2.5) + (of_balls ? 0.5 : 0.0));
    std::string text = fmt::format("kind: disc, center_m: {}, radius_m: {:.4g}, spacing_m: {:.4g}",
                                   shell_point(x, y), radius, spacing);
    if (of_rings) text += ", structure: rings";
    if (space_ == 3 && shell_between(0.0, 1.0) < 0.5) text += ", plane: yz";
    text += of_balls
                ? fmt::format(", ball: {{mass_kg: {:.4g}, radius_m: {:.4g}}}", mass, 0.5 * spacing)
                : fmt::format(", mass_kg: {:.4g}", mass);
    text += shell_links("");
    if (!of_rings && shell_between(0.0, 1.0) < 0.4) text += shell_links("shear_");
    return text;
  }

  /// In a tenth of the scenes a skin or a disc, of up to 43 MATs, which moves, turns, and touches the masses or
  /// hangs on one.
  void perhaps_add_shell() {
    if (shell_between(0.0, 1.0) > 0.1) return;
    std::string body = shell_between(0.0, 1.0) < 0.5 ? skin() : disc();
    const double speed = shell_between(-0.3, 0.3);
    if (shell_between(0.0, 1.0) < 0.5) {
      body += fmt::format(", velocity_m_per_s: [{:.4g}, 0{}]", speed, space_ == 3 ? ", 0" : "");
      const double turn = shell_between(-5.0, 5.0);
      if (shell_between(0.0, 1.0) < 0.5) {
        body += space_ == 2 ? fmt::format(", spin_rad_per_s: {:.4g}", turn)
                            : fmt::format(", spin_rad_per_s: [1, {:.4g}, 0]", turn);
      }
    } else {
      body += perhaps_start_by_formula(0.5);
    }
    masses_ += "  shell: {" + body + "}\n";
    liaisons_ += fmt::format(
        "  of_shell: {{kind: state_machine, stiffness_n_per_m: {:.4g}, pulls: false}}\n",
        shell_decades(5.0, 3000.0));
    if (shell_between(0.0, 1.0) < 0.5) {
      links_ += "  - {liaison: of_shell, between_sets: [p, shell], rest_m: 0.05, range_m: 0.05}\n";
    } else {
      links_ += fmt::format(
          "  - {{liaison: of_shell, between: [\"p[0]\", \"shell[1]\"], rest_m: {:.4g}}}\n",
          shell_between(0.05, 0.3));
    }
  }

  /// Stiffness and perhaps viscosity of links of a net. @param prefix  of the keys
  std::string springs_of_net(const std::string& prefix) {
    std::string text =
        fmt::format(", {}stiffness_n_per_m: {:.4g}", prefix, nets_.decades(5.0, 2000.0));
    const double viscosity = nets_.decades(1e-4, 0.5);
    if (matter_ == Matter::kAnything && nets_.chance(0.6))
      text += fmt::format(", {}viscosity_n_s_per_m: {:.4g}", prefix, viscosity);
    return text;
  }

  /// In one scene of fifteen a net, held at its border or not, with links across its cells.
  void perhaps_add_net() {
    if (!nets_.chance(1.0 / 15.0)) return;
    const char* const border = nets_.one_of<const char*>({"free", "fixed", "corners"});
    const char* const plane = nets_.one_of<const char*>({"xy", "xz", "yz"});
    const std::uint32_t columns = 3 + nets_.below(2);
    const double spacing = nets_.between(0.02, 0.06);
    const double x = nets_.between(-0.2, 0.1);
    const double mass = nets_.decades(0.001, 0.05);
    const std::string along = springs_of_net("");
    const std::string across = springs_of_net("shear_");
    masses_ += fmt::format(
        "  net: {{kind: grid, rows: 3, columns: {}, corner_m: [{:.4g}, 0.25{}, spacing_m: {:.4g}, "
        "border: {}, mass_kg: {:.4g}{}{}}}\n",
        columns, x, space_ == 3 ? fmt::format(", 0.05], plane: {}", plane) : "]", spacing, border,
        mass, along, across);
    liaisons_ +=
        fmt::format("  of_net: {{kind: state_machine, stiffness_n_per_m: {:.4g}, pulls: false}}\n",
                    nets_.decades(5.0, 1000.0));
    links_ += "  - {liaison: of_net, between: [\"p[0]\", \"net[4]\"], rest_m: 0.05}\n";
  }

  /// In one scene of twelve the first mass hangs on the wall by two or three liaisons beside each other.
  void perhaps_add_parallel() {
    if (!beside_.chance(1.0 / 12.0)) return;
    const bool may_damp = matter_ == Matter::kAnything;
    std::string parts =
        fmt::format("{{kind: spring, stiffness_n_per_m: {:.4g}}}", beside_.decades(1.0, 500.0));
    const std::uint32_t kind = beside_.below(may_damp ? 3 : 1);
    const double stiffness = beside_.decades(1.0, 500.0);
    const double viscosity = beside_.decades(1e-3, 1.0);
    if (kind == 1)
      parts += fmt::format(", {{kind: damper, viscosity_n_s_per_m: {:.4g}}}", viscosity);
    if (kind == 2 && !freezes_) {
      parts +=
          fmt::format(", {{kind: maxwell, stiffness_n_per_m: {:.4g}, viscosity_n_s_per_m: {:.4g}}}",
                      stiffness, viscosity);
    }
    parts += fmt::format(", {{stiffness_n_per_m: {:.4g}, pulls: false}}", stiffness);
    liaisons_ += "  beside: {parallel: [" + parts + "]}\n";
    links_ += "  - {liaison: beside, between: [wall, \"p[0]\"]}\n";
  }

  /// In an eighth of the scenes signals of a whole: pieces of what is near, and a momentum about a point.
  void perhaps_count() {
    if (!counts_.chance(0.125)) return;
    signals_ += fmt::format("  lumps: {{of: p, quantity: pieces, near_m: {:.4g}}}\n",
                            counts_.decades(0.01, 0.3));
    if (space_ == 1) return;
    const double x = counts_.between(-0.3, 0.3);
    signals_ += space_ == 2 ? fmt::format(
                                  "  turned: {{of: p, quantity: angular_momentum, about_m: "
                                  "[{:.4g}, 0.1]}}\n",
                                  x)
                            : fmt::format(
                                  "  turned: {{of: p, quantity: angular_momentum, about_m: "
                                  "[{:.4g}, 0.1, 0], axis: y}}\n",
                                  x);
  }

  void add_set() {
    std::string law;
    if (matter_ == Matter::kPotentials) {
      law = one_state();
    } else if (chance(0.3)) {
      law = state_machine();
    } else if (chance(0.5)) {
      const double z = viscosity();
      law = fmt::format(
          "{{kind: state_machine, stiffness_n_per_m: {:.4g}, viscosity_n_s_per_m: {:.4g}, pulls: "
          "false}}",
          stiffness(), z);
    } else {
      law = one_state();
    }
    liaisons_ += "  of_set: " + perhaps_rubbing(law) + "\n";
    const double range = decades(0.03, 1.0);
    const std::string rest =
        chance(0.5) ? "rest: radii" : fmt::format("rest_m: {:.4g}", range * between(0.2, 1.0));
    const std::string which = count_ == 1 || chance(0.4) ? "between_sets: [wall, p]" : "within: p";
    links_ += fmt::format("  - {{liaison: of_set, {}, {}, range_m: {:.4g}}}\n", which, rest, range);
  }

  /// A direction as the numbers of a vector, of some length.
  std::string direction(const std::vector<double>& towards) {
    if (space_ == 1) return towards[0] > 0.0 ? "x" : "-x";
    std::string text = "[";
    for (int axis = 0; axis < space_; ++axis) {
      text +=
          fmt::format("{}{:.5g}", axis > 0 ? ", " : "", towards[static_cast<std::size_t>(axis)]);
    }
    return text + "]";
  }

  /// A plane, a box or a cylinder beside the masses, of which some reach into it.
  std::string surface() {
    std::vector<double> outwards;
    for (int axis = 0; axis < space_; ++axis) outwards.push_back(between(-1.0, 1.0));
    const std::uint32_t kind = below(space_ == 1 ? 2 : 3);
    const double away = between(0.1, 0.25);
    double length = 0.0;
    for (const double share : outwards) length += share * share;
    length = std::max(std::sqrt(length), 1e-3);
    std::vector<double> centre;
    std::vector<double> towards;
    for (const double share : outwards) {
      centre.push_back((kind == 0 ? away : away + 0.15) * share / length);
      towards.push_back(-share / length);
    }
    const std::string place = space_ == 1 ? fmt::format("{:.5g}", centre[0]) : direction(centre);
    if (kind == 0) {
      return fmt::format("{{kind: plane, at_m: {}, normal: {}{}}}", place, direction(towards),
                         chance(0.2) ? ", sides: both" : "");
    }
    if (kind == 1) {
      std::vector<double> size;
      for (int axis = 0; axis < space_; ++axis) size.push_back(between(0.05, 0.3));
      const std::string text = space_ == 1 ? fmt::format("{:.5g}", size[0]) : direction(size);
      return fmt::format("{{kind: box, center_m: {}, size_m: {}}}", place, text);
    }
    const double radius = between(0.03, 0.15);
    std::string more;
    if (space_ == 3) {
      more = ", axis: " + std::string(one_of<const char*>({"x", "y", "z", "[1, 1, 0]"}));
      if (chance(0.5)) more += fmt::format(", length_m: {:.5g}", between(0.05, 0.4));
    }
    return fmt::format("{{kind: cylinder, center_m: {}, radius_m: {:.5g}{}}}", place, radius, more);
  }

  /// Writes one beside the masses in four scenes of ten, or none. @return how it goes on in a list of surfaces
  std::string polyline() {
    const auto between = [this](double low, double high) {
      return low + (high - low) * static_cast<double>(random_of_polylines_()) / 4294967296.0;
    };
    if (between(0.0, 1.0) > 0.4) return {};
    const auto corners = 2 + static_cast<int>(between(0.0, 5.0));
    double x = between(-0.3, 0.0);
    double y = between(-0.3, 0.3);
    std::string text;
    for (int i = 0; i < corners; ++i) {
      text += fmt::format("{}[{:.5g}, {:.5g}]", i > 0 ? ", " : "", x, y);
      x += between(0.02, 0.2);
      y += between(-0.15, 0.15);
    }
    const bool closed = corners > 2 && between(0.0, 1.0) < 0.3;
    masses_ += fmt::format("  line: {{kind: polyline, corners_m: [{}]{}}}\n", text,
                           closed ? ", closed: true" : "");
    return ", line";
  }

  /// A hollow box or cylinder about all masses or some, in four scenes of ten. @return how it goes on in a list of
  /// surfaces
  std::string hollow() {
    const auto between = [this](double low, double high) {
      return low + (high - low) * static_cast<double>(random_of_hollows_()) / 4294967296.0;
    };
    if (between(0.0, 1.0) > 0.4) return {};
    const bool is_round = space_ > 1 && between(0.0, 1.0) < 0.5;
    const auto numbers = [&](double low, double high) {
      std::string text;
      for (int axis = 0; axis < space_; ++axis)
        text += fmt::format("{}{:.5g}", axis > 0 ? ", " : "", between(low, high));
      return space_ > 1 ? "[" + text + "]" : text;
    };
    std::string body = fmt::format("{{kind: {}, center_m: {}, sides: both",
                                   is_round ? "cylinder" : "box", numbers(-0.1, 0.1));
    if (is_round) {
      body += fmt::format(", radius_m: {:.5g}", between(0.03, 0.5));
      if (space_ == 3 && between(0.0, 1.0) < 0.5)
        body += fmt::format(", axis: [1, 2, 0], length_m: {:.5g}", between(0.1, 1.0));
      else if (space_ == 3)
        body += ", axis: y";
    } else {
      body += ", size_m: " + numbers(0.05, 1.0);
    }
    masses_ += "  hollow: " + perhaps_driven(body + "}") + "\n";
    return ", hollow";
  }

  /// In one scene of twelve the scene is asked to settle. Not every one comes to rest.
  std::string perhaps_settle() {
    const auto between = [this](double low, double high) {
      return low + (high - low) * static_cast<double>(random_of_rest_()) / 4294967296.0;
    };
    if (between(0.0, 1.0) > 1.0 / 12.0) return {};
    return fmt::format("settle: {{until_n: {:.3g}, steps: 5000, friction: {}}}\n",
                       std::pow(10.0, between(-9.0, -2.0)), between(0.0, 1.0) < 0.7);
  }

  /// A surface in eight is shaken.
  std::string perhaps_driven(std::string surface) {
    if (matter_ == Matter::kPotentials || drive_between(0.0, 1.0) > 0.125) return surface;
    surface.insert(surface.size() - 1,
                   ", driven: {displacement_m: " + function_of_time(0.02) + "}");
    return surface;
  }

  /// In an eighth of the scenes fixed matter without a liaison, or a part that is fixed, on which the first mass
  /// hangs.
  void perhaps_add_still_matter(bool may_be_part) {
    const auto between = [this](double low, double high) {
      return low + (high - low) * static_cast<double>(random_of_still_matter_()) / 4294967296.0;
    };
    const auto point = [&] {
      std::string text = "[";
      for (int axis = 0; axis < space_; ++axis)
        text += fmt::format("{}{:.5g}", axis > 0 ? ", " : "", between(-0.3, 0.3));
      return text + "]";
    };
    const double choice = between(0.0, 1.0);
    if (choice > 0.125) return;
    const bool is_part = may_be_part && choice < 0.06;
    if (is_part) {
      parts_ = fmt::format(
          "parts: {{nail: {{matter: {{x: {{kind: string, count: 3, from_m: {}, to_m: {}, mass_kg: "
          "0.01, "
          "stiffness_n_per_m: 30, medium_viscosity_n_s_per_m: 0.1}}}}}}}}\n",
          point(), point());
      masses_ += "  still: {part: nail, fixed: true}\n";
    } else {
      const std::string from = point();
      masses_ += "  still: {" + obstacle(from, point()) + ", fixed: true}\n";
      if (obstacles_.chance(0.6)) touch_obstacle();
    }
    liaisons_ += fmt::format(
        "  hanger: {{kind: spring_damper, stiffness_n_per_m: {:.4g}, viscosity_n_s_per_m: 0}}\n",
        std::pow(10.0, between(0.0, 2.0)));
    links_ += fmt::format("  - {{liaison: hanger, between: [\"p[0]\", \"still{}[1]\"]}}\n",
                          is_part ? ".x" : "");
  }

  /// A string, a crystal, a beam or a pack of balls, without `fixed`.
  std::string obstacle(const std::string& first_end, const std::string& last_end) {
    const double spacing = obstacles_.between(0.02, 0.06);
    switch (obstacles_.below(4)) {
      case 0:
        return fmt::format("kind: string, count: 3, from_m: {}, to_m: {}", first_end, last_end);
      case 1:
        return fmt::format(
            "kind: lattice, structure: {}, spacing_m: {:.4g}, corner_m: {}, counts: {}",
            space_ == 3 ? "fcc" : "square", spacing, first_end,
            space_ == 3 ? "[2, 1, 1]" : "[3, 2]");
      case 2:
        return fmt::format("kind: beam, cells: 2, from_m: {}, to_m: {}, height_m: {:.4g}{}",
                           first_end, last_end, spacing,
                           space_ == 3 ? fmt::format(", width_m: {:.4g}", spacing) : "");
      default:
        return fmt::format(
            "kind: pack, ball: {{radius_m: 0.01}}, region: {{center_m: {}, radius_m: {:.4g}}}, "
            "count: 4, seed: 1",
            first_end, 0.03 + spacing);
    }
  }

  /// The masses touch the obstacle.
  void touch_obstacle() {
    const double stiffness = obstacles_.decades(5.0, 3000.0);
    liaisons_ +=
        fmt::format("  of_obstacle: {{stiffness_n_per_m: {:.4g}, pulls: false}}\n", stiffness);
    links_ += "  - {liaison: of_obstacle, between_sets: [p, still], rest_m: 0.06, range_m: 0.06}\n";
  }

  void add_surfaces() {
    const std::uint32_t surfaces = 1 + below(3);
    std::string names;
    for (std::uint32_t s = 0; s < surfaces; ++s) {
      masses_ += fmt::format("  f{}: {}\n", s, perhaps_driven(surface()));
      names += fmt::format("{}f{}", s > 0 ? ", " : "", s);
    }
    if (space_ == 2) names += polyline();
    names += hollow();
    std::string law;
    do {
      law = matter_ != Matter::kPotentials && chance(0.3) ? state_machine() : one_state();
    } while (law.find("lennard_jones") != std::string::npos);
    if (chance(0.5)) {
      law = fmt::format("{{kind: state_machine, stiffness_n_per_m: {:.4g}, pulls: false}}",
                        stiffness());
    }
    liaisons_ += "  of_surface: " + perhaps_rubbing(law) + "\n";
    const double range = decades(0.03, 0.5);
    const std::string rest =
        chance(0.5) ? "rest: radii" : fmt::format("rest_m: {:.4g}", range * between(0.2, 1.0));
    links_ +=
        fmt::format("  - {{liaison: of_surface, between_sets: [p, [{}]], {}, range_m: {:.4g}}}\n",
                    names, rest, range);
  }

  std::uint32_t seed_;
  std::mt19937 random_;
  std::mt19937 friction_random_;
  std::mt19937 random_of_drives_;     // by itself: what a seed draws besides does not depend on it
  std::mt19937 random_of_variables_;  // likewise
  std::mt19937 random_of_media_;      // likewise
  std::mt19937 random_of_bends_;      // likewise
  std::mt19937 random_of_laws_of_bends_;
  std::mt19937 random_of_polylines_;     // likewise
  std::mt19937 random_of_lively_laws_;   // likewise
  std::mt19937 random_of_crowds_;        // likewise
  std::mt19937 random_of_fields_;        // likewise
  std::mt19937 random_of_bodies_;        // likewise
  std::mt19937 random_of_shells_;        // likewise
  std::mt19937 random_of_parameters_;    // likewise
  std::mt19937 random_of_still_matter_;  // likewise
  std::mt19937 random_of_hollows_;       // likewise
  std::mt19937 random_of_rest_;          // likewise
  std::mt19937 random_of_formulas_;      // likewise
  std::mt19937 random_of_places_;        // likewise
  RandomNumbers starts_;
  RandomNumbers leads_;
  RandomNumbers asking_;       // fields that ask for signals
  RandomNumbers links_asked_;  // by conditions
  RandomNumbers obstacles_;
  RandomNumbers shots_;
  RandomNumbers nets_;
  RandomNumbers beside_;  // liaisons in parallel
  RandomNumbers counts_;  // signals of a whole
  bool freezes_ = false;
  bool may_rub_ = false;
  bool has_no_medium_ = false;  // its masses
  int space_ = 3;
  Matter matter_ = Matter::kAnything;
  std::uint32_t count_ = 1;
  bool has_port_ = false;
  std::uint32_t links_with_states_ = 0;                 // that have been written; each has a name
  std::vector<std::vector<std::string>> links_to_ask_;  // what later conditions ask each link for
  std::string head_;
  std::string parts_;
  std::string masses_;
  std::string port_;
  std::string liaisons_;
  std::string links_;
  std::string signals_;
};

}  // namespace

std::string random_scene_text(std::uint32_t seed) {
  return SceneWriter(seed).text();
}

}  // namespace cordis::test
