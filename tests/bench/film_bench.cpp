// tests/bench/film_bench.cpp -- what 10 s of film of 10,000 balls cost at 1280 x 720 and 25 Hz.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "cli/film/film_writer.h"
#include "idl/scene.h"
#include "viz_node/render/film_view.h"

namespace {

using namespace cordis;

constexpr std::size_t kBalls = 10'000;
constexpr std::size_t kColumns = 25;  // of balls along x and z
constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kImages = 250;
constexpr double kRate = 25.0;  // [images/s]

/// A block of balls in space, 1 m wide.
msg::SceneDescription block() {
  msg::SceneDescription description;
  description.name("block");
  description.space(3);
  description.frame_rate_hz(kRate);
  description.mat_kind().assign(kBalls, msg::MAT_MASS);
  description.mat_radius_m().assign(kBalls, 0.018F);
  msg::NamedRange range;
  range.name("balls");
  range.first(0);
  range.count(kBalls);
  description.matter({range});
  return description;
}

/// The block, sheared to and fro.
msg::SceneFrame moment(int number) {
  msg::SceneFrame frame;
  frame.frame(static_cast<std::uint64_t>(number) + 1);
  frame.simulated_s(number / kRate);
  frame.position_m().resize(3 * kBalls);
  const double shear = std::sin(2.0 * std::numbers::pi * number / kRate);
  for (std::size_t ball = 0; ball < kBalls; ++ball) {
    const auto column = static_cast<double>(ball % kColumns);
    const auto row = static_cast<double>(ball / kColumns % kColumns);
    const auto layer = static_cast<double>(ball / kColumns / kColumns);
    float* position = frame.position_m().data() + 3 * ball;
    position[0] = static_cast<float>(0.04 * column + 0.3 * shear * 0.04 * layer);
    position[1] = static_cast<float>(0.04 * layer);
    position[2] = static_cast<float>(0.04 * row);
  }
  return frame;
}

void draw_film(benchmark::State& state) {
  const msg::SceneDescription description = block();
  for (auto _ : state) {
    viz::FilmView view(description, {.width = kWidth, .height = kHeight});
    for (int number = 0; number < kImages; ++number)
      benchmark::DoNotOptimize(view.draw(moment(number)).bytes().data());
  }
}
BENCHMARK(draw_film)->Unit(benchmark::kSecond)->UseRealTime();

/// The whole way into a file, ffmpeg included.
void write_film(benchmark::State& state, const char* ending) {
  const msg::SceneDescription description = block();
  const std::string path = std::filesystem::temp_directory_path() /
                           ("cordis_film_bench_" + std::to_string(getpid()) + ending);
  for (auto _ : state) {
    viz::FilmView view(description, {.width = kWidth, .height = kHeight});
    cli::FilmWriter writer(path, kWidth, kHeight, kRate);
    for (int number = 0; number < kImages; ++number) writer.write(view.draw(moment(number)));
    writer.finish();
  }
  std::filesystem::remove(path);
}
BENCHMARK_CAPTURE(write_film, mp4, ".mp4")->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK_CAPTURE(write_film, webm, ".webm")->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
