// sim_node/plan/stability/start_tangent.h -- the step beyond which a scene surely diverges from its
// start.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/bend_shape.h"
#include "sim_node/plan/stability/slope.h"

namespace cordis::plan {

/// The linear network that a scene is for small movements about the pose of its start. It has every
/// link with its tangent there. State links and the pairs of a set count in the state of their
/// start, as far as they pull or push there. The weights are those of its integrator at its step
/// (LimitWeights). A set of more than StartPairs::kMaxPairs pairs is left out. The ends of a law
/// that has a step at the start, such as dry friction, count as held: small movements may not begin
/// there. So do those of a law that drives the motion beside implicit dampers: its limit is not known. A link that
/// `leapfrog` solves is stable beyond the K' of 4 where its Z' is above 2: up to a step, its ends count as held too.
///
/// In 1 dimension, for linear links alone, this is the network itself, and its limit is exact.
class StartTangent {
 public:
  /// @param solved_up_to  the step [s] at which Z' of what `leapfrog` solves is taken
  StartTangent(const engine::NetworkDescription& network, double solved_up_to);
  explicit StartTangent(const engine::NetworkDescription& network)
      : StartTangent(network, network.step) {}

  /// Beyond this step [s] the network diverges: 4 M - dt^2 K - 2 dt Z then has a direction below 0,
  /// that is an eigenvalue of the scheme below -1. Comes down to the true limit: for up to some
  /// thousand links to within 1e-7 of it, for many as near as a tenth of a second of work allows.
  /// Infinite where nothing pulls, and where `leapfrog` solves friction beside implicit dampers, for
  /// which no limit is known.
  double diverging_step() const;

 private:
  /// One link: stiffness along and across its direction, viscosity along.
  struct Part {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    Eigen::Vector3d direction;
    double along;
    double across;
    double viscosity;
    double maxwell_viscosity;  // 0 unless a Maxwell element, whose stiffness is `along`
  };
  /// A liaison of three MATs: stiffness in all directions, more of it and viscosity along one.
  struct BendPart {
    engine::Bend bend;
    engine::BendShape turn;  // of the bend, without its rest angle in 1 dimension
    Eigen::Vector3d direction;
    double stiffness;
    double viscosity;
    double stiffness_along;  // beside the other
  };
  using Columns = Eigen::Matrix3Xd;

  void add_bend(const engine::NetworkDescription& network, const engine::Bend& bend,
                double stiffness_weight, double viscosity_weight);
  void add(std::uint32_t a, std::uint32_t b, const engine::NetworkDescription& network,
           double along, double tension, double viscosity, double maxwell_viscosity);
  void add_set(const engine::NetworkDescription& network, const engine::SetLiaison& set,
               double stiffness_weight, double viscosity_weight);
  void add_at_surface(const engine::Surface& surface, std::uint32_t ball,
                      const engine::NetworkDescription& network, double along, double tension,
                      double viscosity);
  void add_around_axis(const engine::Surface& surface, std::uint32_t ball,
                       const engine::NetworkDescription& network, double tension);
  /// True for a law that drives the motion beside implicit dampers.
  bool drives_beside_dampers(const Tangent& tangent) const;
  void hold(std::uint32_t a, std::uint32_t b);
  void add_vector_spring(const engine::Link& link, double stiffness, double viscosity);
  /// M^-1/2 (stiffness_factor K + viscosity_factor Z) M^-1/2 x; Maxwell elements as at a step.
  Columns times(const Columns& x, double stiffness_factor, double viscosity_factor,
                double step) const;
  /// Likewise, into columns that keep their memory.
  /// @param moved  room for M^-1/2 x
  void multiply(const Columns& x, double stiffness_factor, double viscosity_factor, double step,
                Columns& moved, Columns& forces) const;
  /// The step at which one direction diverges [s]; infinite: none. Maxwell elements as at a step.
  double diverging_step_of(const Columns& x, double maxwell_step) const;
  /// Goes from a direction that diverges at no step to one that does, if it finds one: towards the largest
  /// stiffness, and towards the largest viscosity.
  /// @return the number of iterations it took
  int leave_flat_direction(Columns& x, int max_iterations) const;
  /// Goes from a direction towards that of the largest eigenvalue at a step.
  /// @return the number of iterations it took
  int climb(Columns& x, double step, int max_iterations) const;

  std::vector<Part> parts_;
  std::vector<BendPart> bends_;
  Eigen::RowVectorXd root_of_inverse_mass_;
  Eigen::RowVectorXd medium_viscosity_;  // per MAT
  int dimension_;
  bool damps_implicitly_;
  bool has_limit_;
};

}  // namespace cordis::plan
