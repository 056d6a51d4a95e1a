// tests/device/wired.h -- drivers at the end of a wire, for tests.
#pragma once

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "device_node/drivers/driver_table.h"
#include "device_node/drivers/hardware.h"

namespace cordis::device {

/// A folder with a path to a serial line that may be there or not.
class Wired : public ::testing::Test {
 protected:
  Wired() {
    std::string name = (std::filesystem::temp_directory_path() / "cordis-wire-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~Wired() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path link() const { return folder_ / "tty"; }
  std::string port() const { return "port: " + link().string(); }

  /// @param where  of the wire and more: `port: ...`
  std::unique_ptr<Driver> driver(const std::string& name, const std::string& where,
                                 const AxisLayout& layout) {
    config::Problems problems;
    const config::Value section = config::load_text(
        "{" + where + ", answer_within_s: 0.0009, lost_after_s: 5, retry_s: 0.01}", name, problems);
    for (const DriverEntry& entry : driver_table()) {
      if (entry.name != name) continue;
      auto made = entry.make(section, layout, problems);
      EXPECT_EQ(problems.text(), "");
      return made;
    }
    return nullptr;
  }

  /// Lives period after period until it is as wanted; false when that takes too long.
  static bool until(Driver& driver, const AxisValues& force,
                    const std::function<bool(bool there)>& wanted) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < limit) {
      if (wanted(driver.write(force))) return true;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return false;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace cordis::device
