// sim_node/plan/reduction/dimension.cpp
#include "sim_node/plan/reduction/dimension.h"

#include <algorithm>
#include <vector>

namespace cordis::plan {
namespace {

using engine::Vec3;

/// True if nothing in the scene is, moves or acts along an axis but at one place.
bool is_confined(const scene::Scene& scene, int axis) {
  const engine::NetworkDescription& network = scene.network;
  if (network.gravity[axis] != 0.0) return false;
  const double place = network.mats.front().position[axis];
  for (const engine::Mat& mat : network.mats) {
    if (mat.position[axis] != place || mat.velocity[axis] != 0.0) return false;
  }
  for (const scene::Port& port : scene.ports) {
    for (const Vec3& direction : port.directions) {
      if (direction[axis] != 0.0) return false;
    }
  }
  return true;
}

bool asks_for_an_axis(const engine::Program& program) {
  return std::any_of(program.code.begin(), program.code.end(), [](const auto& instruction) {
    return instruction.operation == engine::Operation::kQuantity &&
           (instruction.quantity == engine::Quantity::kSpeedX ||
            instruction.quantity == engine::Quantity::kSpeedY ||
            instruction.quantity == engine::Quantity::kSpeedZ);
  });
}

bool asks_for_an_axis(const engine::NetworkDescription& network) {
  for (const engine::StateMachine& state_machine : network.state_machines) {
    for (const engine::Transition& exit : state_machine.exits) {
      if (asks_for_an_axis(exit.when) || asks_for_an_axis(exit.rest_length)) return true;
    }
  }
  return false;
}

/// True if a signal or a condition asks for such a variable.
template <class Is>
bool asks_for(const scene::Scene& scene, Is is) {
  return std::ranges::any_of(scene.signals.signals(), is) ||
         std::ranges::any_of(scene.network.variables, is);
}

/// True if something asks for an angular momentum, which has no plane or line that is left to lie in.
bool asks_for_angular_momentum(const scene::Scene& scene) {
  return asks_for(scene, [](const engine::Variable& variable) {
    return variable.quantity == engine::VariableKind::kAngularMomentum;
  });
}

/// True if something asks for the angle of a bend, which has a sign in a plane, and none in space.
bool asks_for_an_angle(const scene::Scene& scene) {
  if (std::ranges::any_of(scene.network.state_machines, engine::asks_for_angle)) return true;
  return asks_for(scene, [](const engine::Variable& variable) {
    const bool is_speed = variable.kind == engine::LinkKind::kBend &&
                          variable.quantity == engine::VariableKind::kSpeed;
    return is_speed || engine::is_of_angle(variable.quantity);
  });
}

/// True if the sign of the links of a line makes no difference.
bool fits_a_line(const scene::Scene& scene) {
  const engine::NetworkDescription& network = scene.network;
  if (!network.state_links.empty()) return false;
  if (std::ranges::any_of(network.state_machines, engine::rubs)) return false;
  const auto is_bent = [](const engine::Bend& bend) {
    return bend.rest_angle != 0.0 || bend.has_states();
  };
  if (std::ranges::any_of(network.bends, is_bent)) return false;
  const auto has_sign = [](const engine::Variable& variable) {
    return (variable.quantity >= engine::VariableKind::kDistance &&
            variable.quantity <= engine::VariableKind::kTension) ||
           engine::is_of_angle(variable.quantity);
  };
  if (asks_for(scene, has_sign)) return false;
  // Where both ends are at one place there is no direction, and no force, but in 1 dimension.
  const auto begins_apart = [&network](const auto& link) {
    const engine::Mat& a = network.mats[link.mat_a];
    const engine::Mat& b = network.mats[link.mat_b];
    return a.position != b.position || a.velocity == b.velocity;
  };
  return std::all_of(network.links.begin(), network.links.end(),
                     [&](const engine::Link& link) {
                       const bool has_length = link.stiffness > 0.0 && link.rest_length != 0.0;
                       return !has_length && begins_apart(link);
                     }) &&
         std::all_of(network.maxwell_links.begin(), network.maxwell_links.end(), begins_apart);
}

/// The vectors of a scene in the directions that are left.
class Projection {
 public:
  explicit Projection(const scene::Subspace& subspace, int dimension)
      : subspace_(subspace), dimension_(dimension) {}

  Vec3 operator()(const Vec3& vector) const {
    Vec3 left = Vec3::Zero();
    for (int k = 0; k < dimension_; ++k) {
      left[k] = vector[subspace_.axes[static_cast<std::size_t>(k)]];
    }
    return left;
  }

 private:
  const scene::Subspace& subspace_;
  int dimension_;
};

void project(const scene::Subspace& subspace, int dimension, scene::Scene& scene) {
  const Projection project(subspace, dimension);
  engine::NetworkDescription& network = scene.network;
  network.dimension = dimension;
  network.gravity = project(network.gravity);
  for (engine::Mat& mat : network.mats) {
    mat.position = project(mat.position);
    mat.velocity = project(mat.velocity);
  }
  for (scene::Port& port : scene.ports) {
    port.rest = project(port.rest);
    for (Vec3& direction : port.directions) direction = project(direction);
  }
  const auto project_variable = [&](engine::Variable& variable) {
    if (variable.quantity == engine::VariableKind::kPosition ||
        variable.quantity == engine::VariableKind::kCenterOfMass) {
      variable.offset -= variable.direction.dot(subspace.origin);  // what never changes
    }
    variable.direction = project(variable.direction);
  };
  std::vector<scene::Signal> signals = scene.signals.signals();
  std::ranges::for_each(signals, project_variable);
  std::ranges::for_each(network.variables, project_variable);
  scene.signals = scene::SignalReader(std::move(signals), network);
  scene.subspace = subspace;
}

}  // namespace

std::string confine(scene::Scene& scene) {
  if (!scene.network.surfaces.empty()) return {};  // what touches them may leave the plane
  if (!scene.network.drives.empty()) return {};    // so may what a function of time moves
  if (asks_for_angular_momentum(scene)) return {};
  scene::Subspace subspace;
  subspace.space = scene.space();
  std::vector<int> left;
  std::string places;
  for (int axis = 0; axis < scene.space(); ++axis) {
    if (!is_confined(scene, axis)) {
      left.push_back(axis);
      continue;
    }
    subspace.origin[axis] = scene.network.mats.front().position[axis];
    places += (places.empty() ? "" : ", ") + std::string(1, static_cast<char>('x' + axis)) + " = " +
              config::number_text(subspace.origin[axis]) + " m";
  }
  const auto dimension = static_cast<int>(left.size());
  const bool fits = dimension > 1 || (dimension == 1 && fits_a_line(scene));
  if (dimension == scene.space() || !fits || asks_for_an_axis(scene.network)) return {};
  if (scene.space() == 3 && asks_for_an_angle(scene)) return {};
  std::copy(left.begin(), left.end(), subspace.axes.begin());
  const std::string before = std::to_string(scene.space());
  project(subspace, dimension, scene);
  return before + "-D computed as " + std::to_string(dimension) + "-D: nothing can ever leave " +
         places;
}

}  // namespace cordis::plan
