// sim_node/scene/matter/start.h -- how matter starts: `velocity_m_per_s`, `spin_rad_per_s`,
// `displacement_m`.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/scene/language/named_formula.h"
#include "sim_node/scene/matter/generated_matter.h"

namespace cordis::scene {

inline constexpr std::array<const char*, 3> kStartKeys{"velocity_m_per_s", "spin_rad_per_s",
                                                       "displacement_m"};

/// A velocity and a spin that all masses of something have at the start.
struct StartMotion {
  engine::Vec3 velocity = engine::Vec3::Zero();  ///< [m/s]
  engine::Vec3 spin = engine::Vec3::Zero();      ///< about the centre of mass [rad/s]

  bool is_rest() const { return velocity.isZero(0.0) && spin.isZero(0.0); }
};

/// `velocity_m_per_s` and `spin_rad_per_s`, as numbers.
StartMotion read_motion(config::MappingReader& reader, int space);

/// Adds it to the velocities of masses; all else stays as it is. @return false when there are none
[[nodiscard]] bool add_motion(const StartMotion& motion, std::span<engine::Mat> mats);

/// How the masses of an entry of `matter:` start, as it is written.
struct StartSpec {
  std::vector<engine::Vec3> velocity;           ///< one for all, or one for each MAT [m/s]
  std::optional<AxisFormulas> velocity_of;      ///< in place of that, over the place of the MAT
  std::optional<AxisFormulas> displacement_of;  ///< from its place, likewise
  engine::Vec3 spin = engine::Vec3::Zero();     ///< [rad/s]
};

/// Reads the three keys, and `parameters` of formulas. Whatever is wrong is a problem.
/// @param for_each  a velocity may be given for each MAT
StartSpec read_start(config::MappingReader& reader, int space, bool for_each,
                     config::Problems& problems);

/// Gives the masses of an entry what it says; what is fixed stays at rest where it is. Links that the
/// entry makes keep their rest lengths. What contradicts it is a problem.
/// @param is_led  their positions are driven
void start(const StartSpec& spec, bool is_led, int space, config::MappingReader& reader,
           GeneratedMatter& matter);

}  // namespace cordis::scene
