// tests/device/wired.h -- drivers at the end of a wire, for tests.
#pragma once

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "device_node/drivers/driver_table.h"
#include "device_node/drivers/hardware.h"
#include "node/config/yaml_reader.h"
#include "node/paced_loop.h"
#include "tests/device/plug.h"
#include "tests/support/captured_log.h"
#include "tests/support/eventually.h"

namespace cordis::device {

using test::CapturedLog;

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
  /// @param retry  when a lost device is tried again
  std::unique_ptr<Driver> driver(const std::string& name, const std::string& where,
                                 const AxisLayout& layout,
                                 const std::string& retry = "retry_s: 0.01") {
    config::Problems problems;
    const config::Value section = config::load_text(
        "{" + where + ", answer_within_s: 0.0009, lost_after_s: 0.2, " + retry + "}", name,
        problems);
    for (const DriverEntry& entry : driver_table()) {
      if (entry.name != name) continue;
      auto driver = entry.make(section, layout, problems);
      EXPECT_EQ(problems.text(), "");
      return driver;
    }
    return nullptr;
  }

  /// @param where  `port: ...` or `udp: ...`
  static std::unique_ptr<Wire> wire_at(const std::string& where) {
    config::Problems problems;
    const config::Value section = config::load_text("{" + where + "}", "wire", problems);
    config::MappingReader reader(section, "wire", problems);
    auto wire = read_wire(reader, 115200);
    EXPECT_EQ(problems.text(), "");
    return wire;
  }

  /// Settings of a driver that counts no device as lost because this machine is busy. No file may
  /// have them.
  static HardwareSettings patient() {
    HardwareSettings settings;
    settings.answer_within_s = 0.0009;
    settings.lost_after_s = 5.0;
    settings.retry_s = 0.01;
    return settings;
  }

  /// Lives period after period of 1 kHz until it is as wanted; false when that takes too long.
  static bool until(Driver& driver, const AxisValues& force,
                    const std::function<bool(bool there)>& wanted) {
    const auto limit = std::chrono::steady_clock::now() + test::kPatience;
    node::PacedLoop pace(1000.0);
    while (std::chrono::steady_clock::now() < limit) {
      pace.wait();
      if (wanted(driver.write(force))) return true;
    }
    return false;
  }

  /// Plugs a device in and lives with it through harm of every kind, until enough of it was found
  /// out; then unplugs it, and lives on until it is lost.
  /// @param check  of what is sensed in every period in which the device is there
  /// @param arrived   whether the device has the force, which it loses when the machine keeps the
  /// driver
  ///               waiting
  static void live_through_harm(Driver& driver, test::Plug& plug, const std::filesystem::path& link,
                                const AxisValues& force,
                                const std::function<void(const AxisValues&)>& check,
                                const std::function<bool()>& arrived) {
    auto& hardware = dynamic_cast<Hardware&>(driver);
    const std::uint64_t bad_before = hardware.bad_count();
    const std::uint64_t late_before = hardware.late_count();
    int periods = 0;
    plug.harm = &test::Plug::every_kind;
    plug.into_serial_line(link);

    ASSERT_TRUE(until(driver, force, [&](bool there) {
      AxisValues sensed{};
      EXPECT_EQ(driver.read(sensed), there || hardware.is_let_go());
      if (there) check(sensed);
      EXPECT_TRUE(there || periods == 0 || hardware.is_let_go()) << "no harm makes it be lost";
      periods += there;
      return periods >= 150 && hardware.bad_count() >= bad_before + 12 &&
             hardware.late_count() >= late_before + 12 && arrived();
    }));
    EXPECT_EQ(hardware.contact(), Contact::kPresent);

    plug.pull();
    ASSERT_TRUE(until(driver, force, [](bool there) { return !there; }));
    AxisValues sensed{};
    EXPECT_FALSE(driver.read(sensed));
    EXPECT_NE(hardware.contact(), Contact::kPresent);
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace cordis::device
