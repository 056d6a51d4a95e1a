// sim_node/engine/integrators/stiffness_matrix.h -- M + dt Z + dt^2 K of the linear links, and its
// factors.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

/// A sparse symmetric positive matrix of fixed pattern, d rows a mass, factored L D L^T without
/// allocation: Eigen's order of least fill, and the numeric phase of Davis's LDL, for that of
/// Eigen's own Cholesky allocates. By + - * / alone, in one order: the same bits everywhere.
class StiffnessMatrix {
 public:
  explicit StiffnessMatrix(const NetworkDescription& network);

  /// Takes the tangents at these positions; of one dimension they never change.
  /// @return false when it is not positive: not finite
  bool assemble(const MatArray& mats) noexcept;
  /// Takes from `change` dt^2 K (displacement) over the links, as a port that rests would have it.
  void subtract_stiffness_times(const MatArray& mats, const double* displacement,
                                double* change) const noexcept;
  /// Adds dt Z (displacement) over the links and the medium to `force` [kg m].
  void add_viscosity_times(const MatArray& mats, const double* displacement,
                           double* force) const noexcept;
  /// first . dt Z (second) over the links and the medium [kg m^2]. Each 4 x N columns [m].
  double viscous_product(const MatArray& mats, const double* first,
                         const double* second) const noexcept;
  /// displacement . dt Z (displacement) by the directions of the links one period ago, less that by
  /// the present ones [kg m^2]. 0 in 1 dimension.
  double turned_product(const MatArray& mats, const double* displacement) const noexcept;
  /// Solves for 4 x N columns in place; what is no mass becomes 0.
  void solve(double* columns) noexcept;

 private:
  struct MatrixLink {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    double stiffness;  // dt^2 K [kg]
    double viscosity;  // dt Z [kg]
    double rest;
    bool isotropic;
    std::uint32_t slot;  // of its block in the column of the later end; kNoSlot without one
  };
  struct Tangent {
    Vec3 direction;
    double along;   // dt^2 K [kg]
    double across;  // [kg]
  };

  void order_masses(const NetworkDescription& network);
  void lay_out(const NetworkDescription& network);
  void find_fill();
  Tangent tangent(const MatArray& mats, const MatrixLink& link) const noexcept;
  void add_link(const MatrixLink& link, const Tangent& tangent) noexcept;
  void add_block(std::uint32_t row_mass, std::uint32_t column_mass, std::uint32_t slot,
                 const Tangent& part, double sign) noexcept;
  bool factor() noexcept;

  int dimension_;
  bool assembled_ = false;
  std::vector<std::uint32_t> place_;  // of each MAT in the order; kNoPlace unless a mass
  std::vector<std::uint32_t> mat_;    // in the order
  std::vector<double> inertia_;       // m + dt Z of the medium, in the order [kg]
  std::vector<double> medium_;        // dt Z of the medium, in the order [kg]
  std::vector<MatrixLink> links_;
  std::vector<std::size_t> column_begin_;  // upper part by columns, rows ascending within blocks
  std::vector<std::uint32_t> row_;
  std::vector<double> value_;
  std::vector<std::int64_t> parent_;  // elimination tree
  std::vector<std::size_t> factor_begin_;
  std::vector<std::size_t> filled_;
  std::vector<std::uint32_t> factor_row_;
  std::vector<double> factor_;
  std::vector<double> pivot_;
  std::vector<double> work_;
  std::vector<std::uint32_t> pattern_;
  std::vector<std::int64_t> flag_;
};

}  // namespace cordis::engine
