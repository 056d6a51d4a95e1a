// sim_node/engine/laws/quadrature.h -- the integral of a function that is known by its values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace cordis::engine {

/// The integral of `f` by halving intervals until the rules of Gauss (7 points) and Kronrod (15)
/// agree to 1e-10 of the whole, at most kMaxPanels times. The ends are never evaluated. Real time:
/// bounded, no allocation.
template <class Function>
class Quadrature {
 public:
  explicit Quadrature(Function f) : f_(f) {}

  double integral(double low, double high) const noexcept {
    struct Interval {
      double low;
      double high;
    };
    std::array<Interval, kMaxDepth + 1> left;  // still to be added
    left[0] = {low, high};
    std::size_t depth = 1;
    double sum = 0.0;
    double size = 0.0;
    for (int panels = 0; depth > 0; ++panels) {
      const Interval next = left[--depth];
      const Panel panel = panel_of(next.low, next.high);
      if (size == 0.0) size = panel.size;
      const bool is_last = panels >= kMaxPanels || depth + 2 > left.size();
      const double error = std::abs(panel.kronrod - panel.gauss);
      if (is_last || !(error > kTolerance * std::max(size, std::abs(sum)))) {
        sum += panel.kronrod;
        continue;
      }
      const double middle = 0.5 * (next.low + next.high);
      left[depth++] = {middle, next.high};
      left[depth++] = {next.low, middle};
    }
    return sum;
  }

 private:
  static constexpr int kMaxPanels = 1024;  // enough for some 250 waves
  static constexpr std::size_t kMaxDepth = 32;
  static constexpr double kTolerance = 1e-10;

  struct Panel {
    double kronrod;
    double gauss;
    double size;  // of the integral, were all values of one sign
  };

  Panel panel_of(double low, double high) const noexcept {
    constexpr std::array<double, 8> kNode = {
        0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
        0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
        0.586087235467691130294144691693299, 0.405845151377397166906606412076961,
        0.207784955007898467600689403773245, 0.0};
    constexpr std::array<double, 8> kKronrod = {
        0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
        0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
        0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
        0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
    constexpr std::array<double, 4> kGauss = {
        0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
        0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
    const double centre = 0.5 * (low + high);
    const double half = 0.5 * (high - low);
    Panel sum{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < kNode.size(); ++i) {
      const double away = half * kNode[i];
      const double low_value = f_(centre - away);
      const double high_value = i + 1 == kNode.size() ? 0.0 : f_(centre + away);
      const double value = low_value + high_value;
      sum.kronrod += kKronrod[i] * value;
      sum.size += kKronrod[i] * (std::abs(low_value) + std::abs(high_value));
      if (i % 2 == 1) sum.gauss += kGauss[i / 2] * value;
    }
    return {half * sum.kronrod, half * sum.gauss, std::abs(half) * sum.size};
  }

  Function f_;
};

/// The integral over a distance. Between two distances of one sign it is taken over their
/// logarithm: laws of a distance are often powers of it.
template <class Function>
double integral_over_distance(Function f, double low, double high) noexcept {
  if (!std::isfinite(low) || !std::isfinite(high) || low == high) return 0.0;
  if (!(low * high > 0.0)) return Quadrature(f).integral(low, high);
  const double sign = low > 0.0 ? 1.0 : -1.0;
  const auto of_logarithm = [&f, sign](double logarithm) {
    const double distance = sign * std::exp(logarithm);
    return f(distance) * distance;
  };
  return Quadrature(of_logarithm).integral(std::log(std::abs(low)), std::log(std::abs(high)));
}

}  // namespace cordis::engine
