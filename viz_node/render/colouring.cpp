// viz_node/render/colouring.cpp
#include "viz_node/render/colouring.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "node/assert.h"
#include "viz_node/render/number_text.h"

namespace cordis::viz {
namespace {

constexpr double kFade = 0.985;      // of the full scale, per frame
constexpr double kSmallShare = 0.4;  // of the radius of balls, where the links are looked at

double distance(const float* a, const float* b) noexcept {
  const double x = double{a[0]} - double{b[0]};
  const double y = double{a[1]} - double{b[1]};
  const double z = double{a[2]} - double{b[2]};
  return std::sqrt(x * x + y * y + z * z);
}

bool is_idle(const msg::SceneFrame& frame, std::size_t link) noexcept {
  return link < frame.link_state().size() && frame.link_state()[link] >= msg::LINK_IS_IDLE;
}

/// The colour at a share, 0..1, of the way from the first to the last.
Colour on_ramp(const std::vector<Colour>& colours, double share) noexcept {
  const double index = std::min(share, 1.0) * static_cast<double>(colours.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(index), colours.size() - 1);
  const std::size_t above = std::min(below + 1, colours.size() - 1);
  return mix(colours[below], colours[above], index - static_cast<double>(below));
}

}  // namespace

Colouring::Colouring(const msg::SceneDescription& description, const Palette& palette)
    : palette_(palette),
      is_free_(description.mat_mass_kg().size(), true),
      masses_(description.mat_mass_kg()),
      link_ends_(description.link_ends()) {}

void Colouring::set_free_masses(std::vector<bool> is_free) {
  CORDIS_ASSERT(is_free.size() == masses_.size());
  is_free_ = std::move(is_free);
}

double Colouring::radius_share() const noexcept {
  return what_ == ColourBy::kStretch ? kSmallShare : 1.0;
}

void Colouring::find_scale(const std::vector<msg::SceneFrame>& frames) {
  Colouring ahead(*this);
  for (const msg::SceneFrame& frame : frames) {
    ahead.take(frame);
    full_ = std::max(full_, ahead.full_);
  }
  is_full_found_ = true;
}

void Colouring::take(const msg::SceneFrame& frame) {
  // A film shows a frame again where it has none of its own. Links may be put into states then.
  if (last_s_ != frame.simulated_s()) {
    if (what_ == ColourBy::kSpeed) find_speeds(frame);
    if (what_ == ColourBy::kForce) find_forces(frame);
    if (what_ == ColourBy::kStretch) find_stretches(frame);
  }
  if (what_ == ColourBy::kComponents) find_components(frame);
  last_s_ = frame.simulated_s();
}

void Colouring::enter(double largest) noexcept {
  if (!is_full_found_) full_ = std::max(kFade * full_, largest);
}

void Colouring::find_speeds(const msg::SceneFrame& frame) {
  const std::vector<float>& now = frame.position_m();
  const double elapsed_s = last_s_ ? frame.simulated_s() - *last_s_ : 0.0;
  if (before_.size() == now.size() && elapsed_s > 0.0) {
    values_.resize(is_free_.size());
    double largest = 0.0;
    for (std::size_t mat = 0; mat < values_.size(); ++mat) {
      values_[mat] = distance(now.data() + 3 * mat, before_.data() + 3 * mat) / elapsed_s;
      if (is_free_[mat]) largest = std::max(largest, values_[mat]);
    }
    enter(largest);
  }
  before_ = now;
}

void Colouring::find_forces(const msg::SceneFrame& frame) {
  forces_.append(frame);
  values_ = forces_.sizes(masses_);
  double largest = 0.0;
  for (std::size_t mat = 0; mat < values_.size(); ++mat)
    if (is_free_[mat]) largest = std::max(largest, values_[mat]);
  enter(largest);
}

void Colouring::find_components(const msg::SceneFrame& frame) {
  std::vector<bool> acts;
  for (std::size_t link = 0; 2 * link < link_ends_.size(); ++link)
    acts.push_back(!is_idle(frame, link));
  if (acts_ == acts) return;
  components_.update(masses_.size(), link_ends_, acts);
  acts_ = std::move(acts);
}

void Colouring::find_stretches(const msg::SceneFrame& frame) {
  const bool is_first = lengths_.empty();
  if (is_first) first_s_ = frame.simulated_s();
  values_.assign(link_ends_.size() / 2, 0.0);
  double largest = 0.0;
  for (std::size_t link = 0; link < values_.size(); ++link) {
    const float* const positions = frame.position_m().data();
    const double length = distance(positions + 3 * std::size_t{link_ends_[2 * link]},
                                   positions + 3 * std::size_t{link_ends_[2 * link + 1]});
    if (is_first) lengths_.push_back(length);
    if (is_idle(frame, link) || lengths_[link] == 0.0) continue;
    values_[link] = length / lengths_[link] - 1.0;
    largest = std::max(largest, std::abs(values_[link]));
  }
  enter(largest);
}

std::optional<Colour> Colouring::of_mass(std::size_t mat) const {
  switch (what_) {
    case ColourBy::kBody:
      return std::nullopt;
    case ColourBy::kSpeed:
      return on_ramp(palette_.speeds, full_ > 0.0 && !values_.empty() ? values_[mat] / full_ : 0.0);
    case ColourBy::kForce:
      if (values_.empty()) return palette_.quiet;
      return on_ramp(palette_.speeds, full_ > 0.0 ? values_[mat] / full_ : 0.0);
    case ColourBy::kComponents:
      if (const std::optional<std::size_t> colour = components_.colour_of(mat))
        return palette_.bodies[*colour % palette_.bodies.size()];
      return palette_.quiet;
    case ColourBy::kStretch:
      return palette_.quiet;
  }
  return std::nullopt;
}

std::optional<Colour> Colouring::of_link(std::size_t link) const {
  if (what_ != ColourBy::kStretch || values_.empty()) return std::nullopt;
  const std::vector<Colour>& colours = palette_.stretches;
  const double half = 0.5 * static_cast<double>(colours.size() - 1);
  const double share = full_ > 0.0 ? std::clamp(values_[link] / full_, -1.0, 1.0) : 0.0;
  return colours[static_cast<std::size_t>(std::lround(half + half * share))];
}

std::optional<ColourScale> Colouring::scale() const {
  switch (what_) {
    case ColourBy::kBody:
    case ColourBy::kComponents:
      return std::nullopt;
    case ColourBy::kSpeed:
      return ColourScale{"0", with_unit(full_, "m/s"), "speed, mean over a frame", palette_.speeds};
    case ColourBy::kForce: {
      const double span_s = forces_.span_s();
      const std::string since =
          span_s > 0.0 ? ", mean over " + with_unit(span_s, "s") : ", from the third frame on";
      return ColourScale{"0", with_unit(full_, "N"), "net force on free masses" + since,
                         palette_.speeds};
    }
    case ColourBy::kStretch: {
      const std::string percent = percent_text(full_);
      return ColourScale{"\u2212" + percent, "+" + percent,
                         "length of links against that at " + fmt::format("{:.2f} s", first_s_) +
                             "; balls are drawn small",
                         palette_.stretches, true};
    }
  }
  return std::nullopt;
}

}  // namespace cordis::viz
