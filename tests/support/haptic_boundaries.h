// tests/support/haptic_boundaries.h -- tests/reference/R20_haptic_boundaries.csv.
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
  int delay = 0;         ///< [periods]
  double stable = 0.0;   ///< K T^2 / m of the device alone
  double passive = 0.0;  ///< K T^2 / m for every passive hand
};

/// All rows; none when the file cannot be read.
inline std::vector<HapticBoundary> haptic_boundaries() {
  std::ifstream file(CORDIS_REFERENCE_DIR "/R20_haptic_boundaries.csv");
  std::string line;
  std::getline(file, line);
  std::vector<HapticBoundary> rows;
  while (std::getline(file, line)) {
    HapticBoundary row;
    const int count = std::sscanf(line.c_str(), "%lf,%lf,%d,%lf,%lf", &row.beta, &row.z, &row.delay,
                                  &row.stable, &row.passive);
    if (count == 5) rows.push_back(row);
  }
  return rows;
}

}  // namespace cordis::test
