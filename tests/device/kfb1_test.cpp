// tests/device/kfb1_test.cpp -- the driver against the reference firmware, over a pseudo-terminal
// and UDP, with damaged, dropped and late answers, unplugged and plugged in again.
#include "device_node/firmware/kfb1.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include "device_node/drivers/kfb1.h"
#include "node/config/yaml_reader.h"
#include "tests/device/kfb1_board.h"
#include "tests/device/wired.h"

namespace cordis::device {
namespace {

static_assert(KFB1_MAX_KEYS == kMaxAxes);

constexpr double kTravel = 0.04;  // [m]
constexpr double kForce = 10.0;   // largest of a motor [N]

using test::Kfb1Board;

AxisLayout layout_of(int keys) {
  AxisLayout layout;
  layout.count = keys;
  layout.lowest_m = -kTravel;
  layout.highest_m = 0.0;
  layout.force_limit_n = kForce;
  return layout;
}

class Kfb1Test : public Wired {
 protected:
  std::unique_ptr<Driver> keys_at(const std::string& where, int keys = 2) {
    return driver("kfb1", where, layout_of(keys));
  }
};

TEST_F(Kfb1Test, CarriesPositionsAndForcesBothWays) {
  Kfb1Board board;
  board.positions[0] = 32767;  // up: 0 m
  board.positions[1] = 0;      // in the middle: -0.02 m
  board.plug.into_serial_line(link());
  const auto key = keys_at(port());
  key->start(Role::kMass);

  ASSERT_TRUE(until(*key, {5.0, -10.0}, [&](bool there) {
    return there && board.forces[0] == 16384 && board.forces[1] == -32767;
  }));
  AxisValues sensed;
  ASSERT_TRUE(until(*key, {5.0, -10.0}, [&](bool there) {
    return there && key->read(sensed) && std::abs(sensed[1] + 0.02) < 1e-6;
  }));
  EXPECT_NEAR(sensed[0], 0.0, 1e-9);

  key->stop();
  EXPECT_TRUE(until(*key, {}, [&](bool) { return board.forces[0] == 0 && board.forces[1] == 0; }));
}

TEST_F(Kfb1Test, SendsTheDeviceTheLargestForceOfItsFile) {
  Kfb1Board board;  // its own is 10 N
  board.plug.into_serial_line(link());
  AxisLayout layout = layout_of(2);
  layout.force_limit_n = 4.0;
  const auto key = driver("kfb1", port(), layout);
  key->start(Role::kMass);

  // A force above the limit, as no guard lets it through: the device itself holds it back.
  EXPECT_TRUE(until(*key, {9.0, -9.0}, [&](bool) {
    return std::abs(board.forces[0] - 0.4 * 32767) < 2 &&
           std::abs(board.forces[1] + 0.4 * 32767) < 2;
  })) << board.forces[0];
}

TEST_F(Kfb1Test, ALargestForceOfManyNewtonsArrivesWhole) {
  Kfb1Board board;
  board.plug.into_serial_line(link());
  AxisLayout layout = layout_of(2);
  layout.force_limit_n = 70.0;  // more millinewtons than 16 bits hold
  const auto key = driver("kfb1", port(), layout);
  key->start(Role::kMass);

  EXPECT_TRUE(until(*key, {9.0, 0.0}, [&](bool there) {
    return there && std::abs(board.forces[0] - 0.9 * 32767) < 2;
  })) << board.forces[0];
}

TEST_F(Kfb1Test, SaysOrCountsAtEachConnectionWhereTheDeviceIsNotWhatItsFileSays) {
  const auto said_of = [&](double travel_m, double force_limit_n) {
    AxisLayout layout = layout_of(2);  // the board: 0.04 m, 10 N
    layout.lowest_m = -travel_m;
    layout.force_limit_n = force_limit_n;
    const CapturedLog log;
    auto key = driver("kfb1", port(), layout);
    key->start(Role::kMass);
    for (int connection = 0; connection < 2; ++connection) {
      Kfb1Board board;
      board.plug.into_serial_line(link());
      EXPECT_TRUE(until(*key, {}, [n = 0](bool there) mutable { return (n += there) == 20; }));
      board.plug.pull();
      EXPECT_TRUE(until(*key, {}, [](bool there) { return !there; }));
    }
    key.reset();
    return log.lines("kfb1:");
  };
  const auto is_twice = [](const std::string& said, const std::string& line) {
    const std::string again =
        line + "\nkfb1: the device was greeted again, and differs from its file: 1 more time";
    return said == line + "\n" + line + "\n" || said.starts_with(again);
  };

  EXPECT_EQ(said_of(0.04, 10.0), "");
  EXPECT_EQ(said_of(0.04, 4.0), "") << "a stronger device receives its limit";
  EXPECT_PRED2(is_twice, said_of(0.05, 10.0),
               "kfb1: the keys have a travel of 0.04 m, and travel_m of the device file is 0.05 "
               "m: scenes are held against that");
  EXPECT_PRED2(is_twice, said_of(0.04, 20.0),
               "kfb1: the motors give 10 N at most, and force_limit_n of the device file is 20 "
               "N: forces above their most are cut off");
}

TEST_F(Kfb1Test, SaysOnceWhyASerialLineCannotBeOpened) {
  const CapturedLog log;
  auto keys = keys_at(port(), 2);
  const auto step = [&] { until(*keys, {}, [n = 0](bool) mutable { return ++n == 50; }); };
  const std::string begins = link().string() + " cannot be opened: ";
  const std::string absent = begins + "No such file or directory\n";
  keys->start(Role::kMass);
  step();
  EXPECT_EQ(log.lines("/"), absent) << "of five tries";

  std::filesystem::create_symlink("/dev/null", link());
  step();
  const std::string no_line = begins + "Inappropriate ioctl for device\n";
  EXPECT_EQ(log.lines("/"), absent + no_line) << "another reason is reported";

  std::filesystem::remove(link());
  Kfb1Board board;
  board.plug.into_serial_line(link());
  EXPECT_TRUE(until(*keys, {}, [](bool there) { return there; }));
  board.plug.pull();
  EXPECT_TRUE(until(*keys, {}, [](bool there) { return !there; }));
  step();
  EXPECT_EQ(log.lines("/"), absent + no_line) << "the same one is counted, once unplugged";
  keys.reset();
  EXPECT_EQ(log.lines("/"), absent + no_line + link().string() + " was not there: 1 more time\n");
}

TEST_F(Kfb1Test, SpeaksUdpToo) {
  Kfb1Board board(16);
  board.positions[15] = -32767;
  const int number = board.plug.into_udp();
  const auto keys = keys_at("udp: '127.0.0.1:" + std::to_string(number) + "'", 16);
  keys->start(Role::kMass);

  AxisValues sensed{};
  EXPECT_TRUE(until(*keys, {}, [&](bool there) {
    return there && keys->read(sensed) && std::abs(sensed[15] + kTravel) < 1e-9;
  }));
}

TEST_F(Kfb1Test, NoTwoDriversTakeTurnsAtOneBoard) {
  for (const bool udp : {false, true}) {
    Kfb1Board board;
    std::string where = port();
    if (udp) where = "udp: '127.0.0.1:" + std::to_string(board.plug.into_udp()) + "'";
    if (!udp) board.plug.into_serial_line(link());
    auto first = keys_at(where);
    const auto second = keys_at(where);
    first->start(Role::kMass);
    ASSERT_TRUE(until(*first, {5.0, 0.0}, [&](bool) { return board.forces[0] == 16384; }));

    second->start(Role::kMass);
    node::PacedLoop pace(1000.0);
    for (int period = 0; period < 20; ++period) {
      pace.wait();
      EXPECT_FALSE(second->write({-5.0, 0.0}));
      EXPECT_GE(board.forces[0], 0);
    }

    first.reset();
    EXPECT_TRUE(until(*second, {-5.0, 0.0}, [&](bool) { return board.forces[0] == -16384; }));
  }
}

TEST_F(Kfb1Test, LivesThroughEveryHarmAndUnpluggingAtOneKilohertz) {
  const auto key = std::make_unique<Kfb1>(wire_at(port()), patient(), layout_of(2));
  key->start(Role::kMass);
  EXPECT_FALSE(key->write({}));  // nothing is there yet
  for (const int up : {16384, -16384, 8192}) {
    Kfb1Board board;
    board.positions[0] = static_cast<std::int16_t>(up);
    board.positions[1] = static_cast<std::int16_t>(-up);
    const double place = 0.02 * up / 32767.0;

    const auto check = [place](const AxisValues& sensed) {
      EXPECT_NEAR(sensed[0], -0.02 + place, 1e-9) << "no damaged position is ever believed";
      EXPECT_NEAR(sensed[1], -0.02 - place, 1e-9);
    };
    live_through_harm(*key, board.plug, link(), {2.0, 1.0}, check,
                      [&] { return board.forces[0] == 6553; });
  }
}

TEST_F(Kfb1Test, BelievesNoFrameWithAWrongChecksum) {
  Kfb1Board board;
  board.positions[0] = 8192;
  board.plug.into_serial_line(link());
  const auto key = std::make_unique<Kfb1>(wire_at(port()), patient(), layout_of(2));
  key->start(Role::kMass);
  const double place = -0.02 + 0.02 * 8192 / 32767.0;
  AxisValues sensed{};
  const auto reads_its_place = [&](bool there) {
    return there && key->read(sensed) && std::abs(sensed[0] - place) < 1e-9;
  };
  ASSERT_TRUE(until(*key, {}, reads_its_place));

  board.miscounts = true;
  ASSERT_TRUE(until(*key, {}, [&, n = 0](bool) mutable {
    if (key->read(sensed)) {
      EXPECT_NEAR(sensed[0], place, 1e-9);
    }
    return ++n == 200;
  }));

  board.miscounts = false;
  EXPECT_TRUE(until(*key, {}, reads_its_place)) << "it is still the same board";
}

/// A line that never falls silent, and never says anything.
class Babble final : public Wire {
 protected:
  bool connect() noexcept override {
    file_ = ::open("/dev/zero", O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return file_ >= 0;
  }
};

TEST_F(Kfb1Test, ADeviceThatBabblesDoesNotStopTheLoop) {
  Kfb1 key(std::make_unique<Babble>(), {}, layout_of(2));
  key.start(Role::kMass);
  for (int n = 0; n < 10; ++n) EXPECT_FALSE(key.write({1.0, 1.0}));
}

TEST_F(Kfb1Test, NothingButASerialLineIsWrittenTo) {
  std::ofstream(link()) << "precious";
  config::Problems problems;
  const auto section = config::load_text("{" + port() + "}", "key.yaml", problems);
  EXPECT_EQ(make_kfb1(section, layout_of(2), problems), nullptr);
  EXPECT_NE(problems.text().find("key.yaml:1:8: error: port must be a serial line like"),
            std::string::npos)
      << problems.text();

  std::filesystem::remove(link());
  const auto key = keys_at(port());  // not there yet
  std::ofstream(link()) << "precious";
  key->start(Role::kMass);
  ASSERT_TRUE(until(*key, {}, [n = 0](bool there) mutable { return there || ++n == 50; }));
  EXPECT_EQ(dynamic_cast<Hardware&>(*key).contact(), Contact::kLost);
  std::string text;
  std::ifstream(link()) >> text;
  EXPECT_EQ(text, "precious");
}

TEST_F(Kfb1Test, TheFirmwareLetsGoWhenNobodySpeaks) {
  Kfb1Board board;
  board.plug.into_serial_line(link());
  const auto key = keys_at(port());
  key->start(Role::kMass);
  ASSERT_TRUE(until(*key, {3.0, 3.0}, [&](bool) { return board.forces[0] > 0; }));

  // The driver falls silent, as after kill -9 of its process: the watchdog of the board bites.
  EXPECT_TRUE(test::eventually([&] { return board.forces[0] == 0 && board.forces[1] == 0; }));
}

TEST_F(Kfb1Test, LetsGoWhileTheBoardReportsAnEmergencyStopAndLogsOrCountsEachOne) {
  for (const int code : {KFB1_TOO_HOT, KFB1_EMERGENCY_STOP}) {
    const CapturedLog log;
    Kfb1Board board;
    board.plug.into_serial_line(link());
    auto key = keys_at(port());
    key->start(Role::kMass);
    ASSERT_TRUE(until(*key, {5.0, 0.0}, [&](bool) { return board.forces[0] == 16384; }));

    for (int stop = 0; stop < 2; ++stop) {
      board.event = code;
      EXPECT_TRUE(until(*key, {5.0, 0.0}, [&](bool there) {
        return !there && key->is_let_go() && board.forces[0] == 0;
      }));
      int periods = 0;  // it goes on as long as the board says so
      EXPECT_TRUE(until(*key, {5.0, 0.0}, [&](bool there) {
        EXPECT_TRUE(!there || board.plug.has_stalled());
        EXPECT_TRUE(board.forces[0] == 0 || board.plug.has_stalled());
        return ++periods == 200;
      }));
      board.event = 0;
      int there_for = 0;  // longer than an event counts as going on
      auto there_since = std::chrono::steady_clock::now();  // the last event may come late
      EXPECT_TRUE(until(*key, {5.0, 0.0}, [&](bool there) {
        const auto now = std::chrono::steady_clock::now();
        if (!there) there_since = now;
        return (there_for += there) > 700 && now > there_since + std::chrono::milliseconds(700);
      }));
      EXPECT_TRUE(until(*key, {5.0, 0.0}, [&](bool) { return board.forces[0] == 16384; }));
    }

    const std::string word = code == KFB1_TOO_HOT ? "it is too hot" : "emergency stop";
    const std::string line = "kfb1: the board reports: " + word + "\n";
    const std::string again = "kfb1: the board reports again: " + word + ": 1 more time";
    key.reset();
    const bool is_counted = !log.lines(again).empty();  // both have come within 5 s
    EXPECT_EQ(log.lines("kfb1: the board reports: " + word), is_counted ? line : line + line);
  }
}

/// The board did not take in that its force ended, and the node ends before it answers again.
TEST_F(Kfb1Test, ABoardThatFellSilentUnderAForceKeepsNoneWhenTheNodeEnds) {
  for (const bool is_closed : {false, true}) {  // the line, at that moment
    Kfb1Board board;
    board.has_watchdog = false;
    board.plug.into_serial_line(link());
    const auto key =
        driver("kfb1", port(), layout_of(2), is_closed ? "retry_s: 30" : "retry_s: 0.01");
    key->start(Role::kMass);
    ASSERT_TRUE(until(*key, {5.0, 0.0}, [&](bool there) { return there && board.forces[0] > 0; }));
    board.is_deaf = board.is_mute = true;
    const Contact away = is_closed ? Contact::kLost : Contact::kGreeting;
    ASSERT_TRUE(until(*key, {5.0, 0.0},
                      [&](bool) { return dynamic_cast<Hardware&>(*key).contact() == away; }));
    ASSERT_GT(board.forces[0], 0);

    board.is_deaf = false;
    key->stop();

    EXPECT_TRUE(test::eventually([&] { return board.forces[0] == 0; })) << is_closed;
  }
}

TEST_F(Kfb1Test, ABoardThatIsGreetedAgainIsGivenNoForceFirst) {
  Kfb1Board board;
  board.has_watchdog = false;
  board.plug.into_serial_line(link());
  const auto key = keys_at(port());
  key->start(Role::kMass);
  ASSERT_TRUE(until(*key, {5.0, 0.0}, [&](bool there) { return there && board.forces[0] > 0; }));
  board.is_deaf = board.is_mute = true;
  ASSERT_TRUE(until(*key, {5.0, 0.0}, [&](bool) {
    return dynamic_cast<Hardware&>(*key).contact() == Contact::kGreeting;
  }));

  board.is_deaf = false;

  EXPECT_TRUE(until(*key, {5.0, 0.0}, [&](bool) { return board.forces[0] == 0; }));
}

TEST_F(Kfb1Test, LetsGoForAPeriodWhenTheWatchdogOfTheBoardHasFired) {
  const CapturedLog log;
  Kfb1Board board;
  board.plug.into_serial_line(link());
  const auto key = keys_at(port());
  key->start(Role::kMass);
  ASSERT_TRUE(until(*key, {5.0, 0.0}, [&](bool) { return board.forces[0] == 16384; }));

  ASSERT_TRUE(test::eventually([&] { return board.forces[0] == 0; }));

  EXPECT_TRUE(until(*key, {5.0, 0.0}, [&](bool there) { return !there && key->is_let_go(); }));
  EXPECT_TRUE(until(*key, {5.0, 0.0}, [&](bool there) { return there; }));
  EXPECT_NE(log.lines("kfb1: the board reports: its watchdog has fired"), "");
}

TEST_F(Kfb1Test, GreetsUntilABoardThatResetsAtTheOpeningOfItsLineAnswers) {
  Kfb1Board board;
  board.deaf_for_s = 0.6;
  board.plug.into_serial_line(link());
  const auto key = driver("kfb1", port(), layout_of(2), "retry_s: 60");
  key->start(Role::kMass);

  EXPECT_TRUE(until(*key, {}, [](bool there) { return there; }));
}

TEST_F(Kfb1Test, SendsABoardThatHasRestartedItsLargestForceAgain) {
  const CapturedLog log;
  Kfb1Board board;
  board.plug.into_serial_line(link());
  AxisLayout layout = layout_of(2);
  layout.force_limit_n = 4.0;
  const auto key = driver("kfb1", port(), layout);
  key->start(Role::kMass);
  const auto is_limited = [&](bool there) {
    return there && std::abs(board.forces[0] - 0.4 * 32767) < 2;
  };
  ASSERT_TRUE(until(*key, {9.0, 0.0}, is_limited));

  board.restarts = true;

  ASSERT_TRUE(until(*key, {9.0, 0.0}, [](bool there) { return !there; }));
  EXPECT_TRUE(until(*key, {9.0, 0.0}, is_limited));
  EXPECT_EQ(log.lines("kfb1: the board has"),
            "kfb1: the board has restarted; it is greeted and configured again\n");
}

TEST_F(Kfb1Test, AnEmptyDatagramDoesNotCloseTheWire) {
  Kfb1Board board(1);
  Kfb1Board* const empties = &board;
  board.on_force = [empties](int, int force) {
    if (force == 16384) empties->plug.say_nothing();
  };
  const auto key = keys_at("udp: '127.0.0.1:" + std::to_string(board.plug.into_udp()) + "'", 1);
  key->start(Role::kMass);
  ASSERT_TRUE(until(*key, {}, [](bool there) { return there; }));

  int periods = 0;
  EXPECT_TRUE(until(*key, {5.0}, [&](bool there) {
    EXPECT_TRUE(there || key->is_let_go() || board.plug.has_stalled());
    return ++periods == 50;
  }));
}

TEST_F(Kfb1Test, ClosingTheLineDoesNotResetABoard) {
  Kfb1Board board;
  board.plug.into_serial_line(link());
  const auto key = keys_at(port());
  key->start(Role::kMass);

  const int line = ::open(link().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  ASSERT_EQ(tcgetattr(line, &settings), 0);
  close(line);
  EXPECT_EQ(settings.c_cflag & HUPCL, 0u);
}

TEST_F(Kfb1Test, CountsADeviceAsLostNoLaterThanAWatchdogWould) {
  const auto problems_with = [&](double lost_after_s, double rate_hz) {
    config::Problems problems;
    AxisLayout layout = layout_of(2);
    layout.rate_hz = rate_hz;
    const auto section =
        config::load_text("{" + port() + ", lost_after_s: " + std::to_string(lost_after_s) + "}",
                          "key.yaml", problems);
    make_kfb1(section, layout, problems);
    return problems.text();
  };

  EXPECT_EQ(problems_with(0.2, 1000.0), "");
  EXPECT_NE(problems_with(0.21, 1000.0).find("must be between 0.002 and 0.2,"), std::string::npos)
      << problems_with(0.21, 1000.0);
  EXPECT_EQ(problems_with(0.6, 10.0), "") << "6 periods";
  EXPECT_NE(problems_with(0.7, 10.0), "");
}

TEST_F(Kfb1Test, RefusesADeviceWithAnotherNumberOfKeys) {
  Kfb1Board board(3);
  board.plug.into_serial_line(link());
  const auto key = keys_at(port(), 2);
  key->start(Role::kMass);

  const auto& hardware = dynamic_cast<Hardware&>(*key);
  bool greeted = false;
  EXPECT_TRUE(until(*key, {5.0, 5.0}, [&](bool there) {
    EXPECT_FALSE(there);
    greeted = greeted || hardware.contact() == Contact::kGreeting;
    return greeted && hardware.contact() == Contact::kLost;
  })) << "the board has answered, and the driver has not closed the line";
  EXPECT_EQ(board.forces[0], 0);
}

TEST_F(Kfb1Test, PlaysRoleLiaisonByACoupling) {
  Kfb1Board board;
  board.positions[0] = 0;  // -0.02 m
  board.positions[1] = 0;
  board.plug.into_serial_line(link());
  const auto key = keys_at(port());
  key->start(Role::kLiaison);

  // Commanded to -0.015 m: 300 N/m over 5 mm pull the key up with 1.5 N; the hand gives -1.5 N.
  AxisValues force{};
  EXPECT_TRUE(until(*key, {-0.015, -0.02}, [&](bool there) {
    return there && key->read(force) && std::abs(force[0] + 1.5) < 0.01;
  })) << force[0];
  EXPECT_NEAR(force[1], 0.0, 0.01);
  EXPECT_TRUE(until(*key, {-0.015, -0.02},
                    [&](bool) { return std::abs(board.forces[0] - 0.15 * 32767) < 40; }));
}

TEST_F(Kfb1Test, PullsToPlacesWithinTheLimitsOfItsFileAndLetsGoOfOldOnes) {
  Kfb1Board board(1);
  board.positions[0] = 0;  // -0.02 m
  board.plug.into_serial_line(link());
  AxisLayout layout = layout_of(1);
  layout.force_limit_n = 4.0;
  layout.slew_n_per_s = 400.0;
  layout.start_ramp_s = 0.0;
  const auto key = driver("kfb1", port(), layout);
  key->start(Role::kLiaison);
  double before = 0.0;
  int since_stall = 100;  // periods
  auto before_read = std::chrono::steady_clock::now();
  const auto motor_force = [&] {  // of the motor, in this period
    AxisValues force{};
    const auto begin = std::chrono::steady_clock::now();
    static_cast<void>(key->read(force));
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - before_read;
    before_read = begin;
    // A board that the machine kept from its forces for 20 ms lets go, and says so within 3 periods.
    since_stall = past.count() > 0.015 ? 0 : since_stall + 1;
    const bool lets_go = since_stall <= 3 && force[0] == 0.0;
    EXPECT_TRUE(lets_go ||
                std::abs(force[0] - before) <= 400.0 * std::max(1e-3, past.count()) + 1e-9)
        << "from " << before << " to " << force[0] << " N: 400 N/s, after " << past.count() << " s";
    EXPECT_LE(std::abs(force[0]), 4.0);
    before = force[0];
    return -force[0];
  };

  // A coupling of 300 N/m wants 6 N at once, over 20 mm.
  ASSERT_TRUE(until(*key, {0.0}, [&](bool) { return motor_force() == 4.0; }));
  EXPECT_TRUE(until(*key, {0.0}, [&](bool) {
    motor_force();
    return std::abs(board.forces[0] - 0.4 * 32767) < 2;
  }));

  // The scene falls silent, and its last place stands.
  double age_s = 0.0;
  ASSERT_TRUE(until(*key, {0.0}, [&](bool) {
    motor_force();
    key->record_age(age_s += 0.001);
    return age_s >= layout.watchdog_s;
  }));
  ASSERT_TRUE(key->write({0.0}));
  EXPECT_EQ(motor_force(), 0.0);
  EXPECT_TRUE(until(*key, {0.0}, [&](bool) { return board.forces[0] == 0; }));
}

TEST(Kfb1Frame, HostAndFirmwareSpeakTheSameCode) {
  // CRC-16/CCITT-FALSE of "123456789" is 0x29B1.
  const std::uint8_t digits[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(kfb1_crc(digits, 9), 0x29B1);

  for (int n = 0; n < 256; ++n) {
    std::uint8_t payload[60];
    for (int i = 0; i < 60; ++i) {
      payload[i] = static_cast<std::uint8_t>((i * n) % 5 == 0 ? 0 : i * n);
    }
    std::uint8_t frame[KFB1_LARGEST_FRAME];
    const std::uint8_t length = kfb1_encode(payload, 60, frame);
    EXPECT_EQ(std::count(frame, frame + length, 0), 1) << "the end alone";
    std::uint8_t back[KFB1_LARGEST_FRAME];
    ASSERT_EQ(kfb1_decode(frame, static_cast<std::uint8_t>(length - 1), back), 60);
    EXPECT_TRUE(std::equal(payload, payload + 60, back));
  }
}

}  // namespace
}  // namespace cordis::device
