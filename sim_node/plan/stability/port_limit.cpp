// sim_node/plan/stability/port_limit.cpp
#include "sim_node/plan/stability/port_limit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace cordis::plan {
namespace {

using Complex = std::complex<double>;

constexpr int kFrequencies = 4000;  // up to half the rate of the device
constexpr int kBisections = 60;

/// (e^x - 1 - x) / x^2 for x <= 0.
double phi2(double x) {
  // The difference of nearly equal numbers near 0: there its series.
  if (x > -0.05) return 0.5 + x / 6.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0 * (1.0 + x / 6.0)));
  return (std::expm1(x) - x) / (x * x);
}

/// A mass with viscosity, from rest under a force of 1 N, or from a speed of 1 m/s without one.
struct HeldMotion {
  HeldMotion(const PortDevice& device, double time) {
    const double x = -time * device.viscosity / device.mass;
    way_of_force = time * time / device.mass * phi2(x);
    way_of_speed = x < 0.0 ? time * std::expm1(x) / x : time;
    speed_of_force = way_of_speed / device.mass;
    speed_of_speed = std::exp(x);
    lost_speed = -std::expm1(x);
  }
  double way_of_force = 0.0;    // [m/N]
  double speed_of_force = 0.0;  // [m/(N s)]
  double way_of_speed = 0.0;    // [s]
  double speed_of_speed = 0.0;
  double lost_speed = 0.0;
};

/// Whole periods of a delay and the part that is left, in [0, 1).
struct SplitDelay {
  explicit SplitDelay(double delay) : whole(std::floor(delay)), part(delay - whole) {}
  double whole;
  double part;
};

/// -1 / G_d(z): what a wall is on the boundary. G(z) is position over force of the mass, the force
/// held over a period and `part` of one late: until then the force before acts.
class WallOnBoundary {
 public:
  WallOnBoundary(const PortDevice& device, const PortLoop& loop)
      : delay_(loop.delay),
        all_(device, loop.period),
        before_(device, delay_.part * loop.period),
        after_(device, (1.0 - delay_.part) * loop.period) {}

  Complex operator()(double theta) const {
    const Complex z = std::polar(1.0, theta);
    const Complex late = 1.0 / z;
    const Complex way = after_.way_of_force + late * (before_.way_of_force +
                                                      after_.way_of_speed * before_.speed_of_force);
    const Complex speed =
        after_.speed_of_force + late * after_.speed_of_speed * before_.speed_of_force;
    const Complex mass =
        (way + all_.way_of_speed * speed / (z - 1.0 + all_.lost_speed)) / (z - 1.0);
    return -std::polar(1.0, delay_.whole * theta) / mass;
  }

 private:
  SplitDelay delay_;
  HeldMotion all_;
  HeldMotion before_;
  HeldMotion after_;
};

/// 1 - 1/z
Complex change_at(double theta) {
  return 1.0 - std::polar(1.0, -theta);
}

/// What a wall K + B (1 - 1/z) / T gives at the frequency w / T: R = gain K - taken B, the same
/// condition for both ends of the part of a period weighted by it.
class PassiveLoop {
 public:
  explicit PassiveLoop(const PortLoop& loop)
      : delay_(loop.delay), period_(loop.period), spread_(delay_.part * (1.0 - delay_.part)) {}

  /// The viscosity that the device must have at w [N s/m].
  double viscosity(double stiffness, double viscosity, double w) const {
    const double real = gain(w) * stiffness - taken(w) * viscosity;
    return 0.5 * (real + std::sqrt(real * real + spread_ * wall_squared(stiffness, viscosity, w)));
  }

  /// The stiffness that viscosity(K, B, w) == b allows [N/m]: the positive root of
  /// s (1-s) T^2 |K + B (1 - e^(-iw)) / T|^2 + 4 b R - 4 b^2 = 0; infinite where none is too much.
  double stiffness(double device_viscosity, double viscosity, double w) const {
    const double b = device_viscosity;
    const double turn = 1.0 - std::cos(w);
    const double constant =
        2.0 * spread_ * viscosity * viscosity * turn - 4.0 * b * (b + viscosity * taken(w));
    if (constant >= 0.0) return 0.0;
    const double linear = 4.0 * b * gain(w) + 2.0 * spread_ * viscosity * period_ * turn;
    const double square = spread_ * period_ * period_;
    const double both = linear + std::sqrt(linear * linear - 4.0 * square * constant);
    return both > 0.0 ? -2.0 * constant / both : std::numeric_limits<double>::infinity();
  }

 private:
  double gain(double w) const {
    const auto of_whole = [&](double d) {
      return w == 0.0 ? d + 0.5 : 0.5 * std::sin((d + 0.5) * w) / std::sin(0.5 * w);
    };
    return period_ * at_delay(of_whole);
  }
  double taken(double w) const {
    return at_delay([&](double d) { return std::cos((d + 1.0) * w); });
  }
  template <class OfWhole>
  double at_delay(const OfWhole& of_whole) const {
    const double first = of_whole(delay_.whole);
    return delay_.part == 0.0
               ? first
               : (1.0 - delay_.part) * first + delay_.part * of_whole(delay_.whole + 1.0);
  }
  /// T^2 |K + B (1 - e^(-iw)) / T|^2
  double wall_squared(double stiffness, double viscosity, double w) const {
    const double spring = stiffness * period_;
    return spring * spring + 2.0 * viscosity * (spring + viscosity) * (1.0 - std::cos(w));
  }

  SplitDelay delay_;
  double period_;
  double spread_;  // s (1 - s)
};

/// The least positive real value that `curve` takes over the angles of the upper half of the unit circle.
template <class Curve>
double min_real_value(const Curve& curve) {
  double least = std::numeric_limits<double>::infinity();
  double theta_before = 1e-4;
  Complex before = curve(theta_before);
  for (int n = 1; n <= kFrequencies; ++n) {
    const double theta = std::numbers::pi * n / kFrequencies;
    const Complex now = curve(theta);
    if (n == kFrequencies && now.real() > 0.0)
      least = std::min(least, now.real());  // z = -1 is real
    if (now.imag() * before.imag() < 0.0) {
      double low = theta_before;
      double high = theta;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (low + high);
        const bool same = curve(middle).imag() * before.imag() > 0.0;
        (same ? low : high) = middle;
      }
      const double value = curve(low).real();
      if (value > 0.0) least = std::min(least, value);
    }
    before = now;
    theta_before = theta;
  }
  return least;
}

}  // namespace

std::vector<PortLoad> port_loads(const LiaisonGraph& graph, LoadBound bound) {
  const bool least = bound == LoadBound::kMin;
  std::vector<PortLoad> loads(graph.inverse_mass.size());
  const auto add = [&](std::uint32_t mat, double count, double stiffness, double viscosity) {
    loads[mat].stiffness += count * stiffness;
    loads[mat].viscosity += count * viscosity;
  };
  for (const Edge& edge : graph.edges) {
    // The edges of a bend are a bound from above.
    if (least && (!edge.bounded || edge.liaison.kind == LiaisonKind::kBend || edge.follows))
      continue;
    add(edge.mat_a, 1.0, edge.stiffness, edge.viscosity);
    if (edge.mat_b != edge.mat_a) add(edge.mat_b, 1.0, edge.stiffness, edge.viscosity);
  }
  for (const ContactBound& contact : graph.contacts) {
    if (least && (!contact.bounded || contact.follows)) continue;
    for (std::size_t i = 0; i < contact.members.size(); ++i) {
      const double count = least ? std::min(1.0, contact.neighbours[i]) : contact.neighbours[i];
      add(contact.members[i], count, contact.stiffness, contact.viscosity);
    }
  }
  for (const ForceBound& force : graph.forces) {
    if (!least) add(force.mat, 1.0, force.stiffness, force.viscosity);
  }
  for (std::size_t mat = 0; mat < loads.size(); ++mat)
    loads[mat].viscosity += graph.medium_viscosity[mat];
  return loads;
}

PortLoad port_load(const LiaisonGraph& graph, std::uint32_t mat) {
  return port_loads(graph, LoadBound::kMax)[mat];
}

PortLoad min_port_load(const LiaisonGraph& graph, std::uint32_t mat) {
  return port_loads(graph, LoadBound::kMin)[mat];
}

double min_device_viscosity(const PortLoad& load, const PortLoop& loop) {
  const PassiveLoop passive(loop);
  double least = 0.0;
  for (int i = 0; i <= kFrequencies; ++i) {
    const double w = std::numbers::pi * i / kFrequencies;
    least = std::max(least, passive.viscosity(load.stiffness, load.viscosity, w));
  }
  return least;
}

double largest_port_stiffness(double device_viscosity, double port_viscosity,
                              const PortLoop& loop) {
  const PassiveLoop passive(loop);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kFrequencies; ++i) {
    const double w = std::numbers::pi * i / kFrequencies;
    least = std::min(least, passive.stiffness(device_viscosity, port_viscosity, w));
  }
  return least;
}

double stable_port_viscosity(const PortDevice& device, const PortLoop& loop) {
  const WallOnBoundary wall(device, loop);
  return min_real_value([&](double theta) { return loop.period * wall(theta) / change_at(theta); });
}

double stable_port_stiffness(const PortDevice& device, double port_viscosity,
                             const PortLoop& loop) {
  if (port_viscosity >= stable_port_viscosity(device, loop)) return 0.0;
  const WallOnBoundary wall(device, loop);
  return min_real_value(
      [&](double theta) { return wall(theta) - port_viscosity * change_at(theta) / loop.period; });
}

double largest_hand_stiffness(const PortLoad& load, double mass, const PortLoop& loop) {
  const double step = loop.period / loop.sub_steps;
  const double limit = 4.0 - 2.0 * load.viscosity * step / mass;
  const double of_scheme = std::max(0.0, limit * mass / (step * step) - load.stiffness);
  const double age = loop.period * (loop.delay + 0.5 * (1.0 - 1.0 / loop.sub_steps));
  return age > 0.0 ? std::min(load.viscosity / age, of_scheme) : of_scheme;
}

}  // namespace cordis::plan
