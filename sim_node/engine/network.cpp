// sim_node/engine/network.cpp
#include "sim_node/engine/network.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim_node/engine/state_hash.h"

namespace cordis::engine {
namespace {

// The step addresses the columns of 4 values with 32-bit offsets.
constexpr std::size_t kMaxMatCount = std::numeric_limits<std::uint32_t>::max() / 4;

void require(bool condition, const std::string& what, const char* expected) {
  if (!condition) throw std::invalid_argument(what + " must be " + expected);
}

bool is_finite_and_at_least_zero(double value) {
  return std::isfinite(value) && value >= 0.0;
}

bool stays_within(const Vec3& value, int dimension) {
  for (int axis = dimension; axis < 3; ++axis) {
    if (value[axis] != 0.0) return false;
  }
  return true;
}

void require_vector(const Vec3& value, int dimension, const std::string& what) {
  require(value.allFinite(), what, "finite");
  require(stays_within(value, dimension), what, "0 beyond the dimension of the network");
}

void check_mat(const NetworkDescription& description, const Mat& mat, const std::string& name) {
  require_vector(mat.position, description.dimension, name + ": position");
  require_vector(mat.velocity, description.dimension, name + ": velocity");
  if (mat.kind != MatKind::kMass) {
    require(mat.velocity.isZero(0.0), name + ": velocity", "0 unless it is a mass");
    return;
  }
  require(std::isfinite(mat.mass) && mat.mass > 0.0, name + ": mass", "finite and > 0");
  const double dt = description.step;
  require(std::isfinite(dt * dt / mat.mass), name + ": mass", "large enough for the step");
  require(std::isfinite(dt * description.medium_viscosity / mat.mass), name + ": mass",
          "large enough for the viscosity of the medium");
}

void check_link(const NetworkDescription& description, const Link& link, const std::string& name) {
  const std::size_t mat_count = description.mats.size();
  require(link.mat_a < mat_count && link.mat_b < mat_count, name + ": both ends",
          "MATs of the network");
  require(link.mat_a != link.mat_b, name + ": its ends", "two different MATs");
  require(is_finite_and_at_least_zero(link.stiffness), name + ": stiffness", "finite and >= 0");
  require(is_finite_and_at_least_zero(link.viscosity), name + ": viscosity", "finite and >= 0");
  require(std::isfinite(link.viscosity / description.step), name + ": viscosity",
          "small enough for the step");
  require(std::isfinite(link.rest_length), name + ": rest length", "finite");
  require(description.dimension == 1 || link.rest_length >= 0.0, name + ": rest length",
          ">= 0 in 2 and 3 dimensions");
}

void check(const NetworkDescription& description) {
  require(description.dimension >= 1 && description.dimension <= 3, "dimension", "1, 2 or 3");
  require(std::isfinite(description.step) && description.step > 0.0, "step", "finite and > 0");
  require_vector(description.gravity, description.dimension, "gravity");
  require(is_finite_and_at_least_zero(description.medium_viscosity), "viscosity of the medium",
          "finite and >= 0");
  require(!description.mats.empty(), "number of MATs", "at least 1");
  require(description.mats.size() <= kMaxMatCount, "number of MATs", "below 2^30");
  for (std::size_t i = 0; i < description.mats.size(); ++i) {
    check_mat(description, description.mats[i], "MAT " + std::to_string(i));
  }
  for (std::size_t l = 0; l < description.links.size(); ++l) {
    check_link(description, description.links[l], "link " + std::to_string(l));
  }
}

void add(StateHash& hash, const Vec3& value) {
  for (const double component : value) hash.add(component);
}

std::uint64_t fingerprint_of(const NetworkDescription& description) {
  StateHash hash;
  hash.add(static_cast<std::uint64_t>(description.dimension));
  hash.add(description.step);
  add(hash, description.gravity);
  hash.add(description.medium_viscosity);
  hash.add(static_cast<std::uint64_t>(description.mats.size()));
  for (const Mat& mat : description.mats) {
    hash.add(static_cast<std::uint64_t>(mat.kind));
    hash.add(mat.mass);
    add(hash, mat.position);
    add(hash, mat.velocity);
  }
  for (const Link& link : description.links) {
    hash.add(static_cast<std::uint64_t>(link.mat_a));
    hash.add(static_cast<std::uint64_t>(link.mat_b));
    hash.add(link.stiffness);
    hash.add(link.viscosity);
    hash.add(link.rest_length);
  }
  return hash.value();
}

}  // namespace

Network::Network(NetworkDescription description) : description_(std::move(description)) {
  check(description_);
  fingerprint_ = fingerprint_of(description_);
}

}  // namespace cordis::engine
