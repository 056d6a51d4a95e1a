// sim_node/engine/simd/modal_kernel_body.h -- the loops over modes.
#pragma once

#include "sim_node/engine/simd/lane_batch.h"
#include "sim_node/engine/simd/modal_kernel.h"

namespace cordis::engine {

/// Argument of step_driven_modes: as many drives as there are.
inline constexpr std::size_t kAnyDrives = ~std::size_t{0};

template <class Lanes>
double read_modes(const double* shape, const double* value, std::size_t count) noexcept {
  using Row = typename Lanes::Row;
  constexpr std::size_t kParts = kModeBatch / Lanes::kWidth;
  Row sum[kParts];
  for (std::size_t part = 0; part < kParts; ++part) sum[part] = Lanes::zero();
  for (std::size_t m = 0; m < count; m += kModeBatch) {
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t mode = m + part * Lanes::kWidth;
      sum[part] = sum[part] + Lanes::load(shape + mode) * Lanes::load(value + mode);
    }
  }
  return LaneBatch<Lanes>::sum(sum);
}

/// Finds the new places of the driven MATs in the same go when there are kDrives of them; of
/// kAnyDrives by reading them afterwards.
template <class Lanes, std::size_t kDrives>
double step_driven_modes(const ModeRows& modes) noexcept {
  using Row = typename Lanes::Row;
  constexpr std::size_t kParts = kModeBatch / Lanes::kWidth;
  constexpr std::size_t kRoom = kDrives == kAnyDrives || kDrives == 0 ? 1 : kDrives;
  constexpr std::size_t kFused = kDrives == kAnyDrives ? 0 : kDrives;
  const ModeRows rows = modes;
  const double* shape[kRoom] = {};
  Row force_there[kRoom];
  Row found[kRoom][kParts];
  Row taken[kParts];
  for (std::size_t part = 0; part < kParts; ++part) taken[part] = Lanes::zero();
  for (std::size_t k = 0; k < kFused; ++k) {
    shape[k] = rows.drives[k].shape;
    force_there[k] = Lanes::every(rows.drives[k].force);
    for (std::size_t part = 0; part < kParts; ++part) found[k][part] = Lanes::zero();
  }
  for (std::size_t m = 0; m < rows.count; m += kModeBatch) {
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t mode = m + part * Lanes::kWidth;
      Row force = Lanes::zero();
      if constexpr (kDrives == kAnyDrives) {
        for (std::size_t k = 0; k < rows.drive_count; ++k) {
          force =
              force + Lanes::every(rows.drives[k].force) * Lanes::load(rows.drives[k].shape + mode);
        }
      }
#pragma GCC unroll 4
      for (std::size_t k = 0; k < kFused; ++k) {
        force = force + force_there[k] * Lanes::load(shape[k] + mode);
      }
      const Row place = Lanes::load(rows.place + mode);
      const Row moved = Lanes::load(rows.moved + mode);
      const Row moving =
          Lanes::load(rows.velocity_retention + mode) * moved -
          Lanes::load(rows.stiffness + mode) * place +
          (Lanes::load(rows.constant + mode) + Lanes::load(rows.gain + mode) * force);
      const Row next = place + moving;
      taken[part] = taken[part] + Lanes::load(rows.dissipation + mode) * (moved * (moved + moving));
      Lanes::store(rows.moved + mode, moving);
      Lanes::store(rows.place + mode, next);
#pragma GCC unroll 4
      for (std::size_t k = 0; k < kFused; ++k) {
        found[k][part] = found[k][part] + Lanes::load(shape[k] + mode) * next;
      }
    }
  }
  for (std::size_t k = 0; k < kFused; ++k) {
    rows.drives[k].place = LaneBatch<Lanes>::sum(found[k]);
  }
  if constexpr (kDrives == kAnyDrives) {
    for (std::size_t k = 0; k < rows.drive_count; ++k) {
      rows.drives[k].place = read_modes<Lanes>(rows.drives[k].shape, rows.place, rows.count);
    }
  }
  return LaneBatch<Lanes>::sum(taken);
}

template <class Lanes>
double step_modes(const ModeRows& modes) noexcept {
  switch (modes.drive_count) {
    case 0:
      return step_driven_modes<Lanes, 0>(modes);
    case 1:
      return step_driven_modes<Lanes, 1>(modes);
    case 2:
      return step_driven_modes<Lanes, 2>(modes);
    default:
      return step_driven_modes<Lanes, kAnyDrives>(modes);
  }
}

template <class Lanes>
constexpr ModalKernel make_modal_kernel() noexcept {
  return ModalKernel{step_modes<Lanes>, read_modes<Lanes>};
}

}  // namespace cordis::engine
