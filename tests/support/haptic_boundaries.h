// tests/support/haptic_boundaries.h -- tests/reference/R20_haptic_boundaries.csv and
// R23_fractional_delay.csv.
#pragma once

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace cordis::test {

/// Where the loop of a device of mass m and viscosity b begins to swing before a wall K + B.
struct HapticBoundary {
  double beta = 0.0;     ///< b T / m
  double z = 0.0;        ///< B T / m
  double delay = 0.0;    ///< [periods]
  double stable = 0.0;   ///< K T^2 / m of the device alone
  double passive = 0.0;  ///< K T^2 / m for every passive hand
};

/// All rows of a table; none when the file cannot be read.
inline std::vector<HapticBoundary> haptic_boundaries_of(const std::string& table) {
  std::ifstream file(CORDIS_REFERENCE_DIR "/" + table);
  std::string line;
  std::getline(file, line);
  std::vector<HapticBoundary> rows;
  while (std::getline(file, line)) {
    HapticBoundary row;
    const int count = std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &row.beta, &row.z,
                                  &row.delay, &row.stable, &row.passive);
    if (count == 5) rows.push_back(row);
  }
  return rows;
}

/// Answers late by whole periods.
inline std::vector<HapticBoundary> haptic_boundaries() {
  return haptic_boundaries_of("R20_haptic_boundaries.csv");
}

/// Answers late by parts of periods.
inline std::vector<HapticBoundary> fractional_boundaries() {
  return haptic_boundaries_of("R23_fractional_delay.csv");
}

}  // namespace cordis::test
