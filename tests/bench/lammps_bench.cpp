// tests/bench/lammps_bench.cpp -- the melt of melt_bench.cpp stepped by LAMMPS, where its program
// `lmp` is installed, on one core: beside our own figures in one table.
//
// usage: engine_bench --benchmark_filter=melt --benchmark_repetitions=5
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <benchmark/benchmark.h>
#include <unistd.h>

namespace {

constexpr int kTimedSteps = 200;

/// What bench/in.lj of LAMMPS says, with 100 steps before those that are timed, as the lattice
/// melts. @param drop  in free space, as in melt_bench.cpp, instead of a periodic box
std::string lammps_input(bool drop) {
  return std::string(drop ? "boundary s s s\n" : "") +
         R"(units lj
atom_style atomic
lattice fcc 0.8442
region box block 0 20 0 20 0 20
create_box 1 box
create_atoms 1 box
mass 1 1.0
velocity all create 1.44 87287 loop geom
pair_style lj/cut 2.5
pair_coeff 1 1 1.0 1.0 2.5
neighbor 0.3 bin
neigh_modify delay 0 every 20 check no
fix 1 all nve
run 100
run )" + std::to_string(kTimedSteps) +
         R"(
compute near all coord/atom cutoff 2.5
compute mean all reduce ave c_near
thermo_style custom step c_mean
run 0
variable pairs equal c_mean/2
print "pairs ${pairs}"
)";
}

/// What LAMMPS has printed of a run.
struct LammpsRun {
  double seconds = 0.0;  ///< processor time of the timed steps
  long balls = 0;
  double pairs_per_ball = 0.0;
};

/// @param opt  by its package OPT, where that is built in: the fastest of one thread in Debian's
/// @return zeros when there is no `lmp`, or it fails.
LammpsRun run_lammps(bool drop, bool opt) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("cordis_lammps_" + std::to_string(getpid()));
  std::ofstream(file) << lammps_input(drop);
  const std::string command = std::string("OMP_NUM_THREADS=1 lmp -log none") +
                              (opt ? " -suffix opt" : "") + " -in " + file.string() + " 2>&1";
  LammpsRun run;
  if (std::FILE* output = popen(command.c_str(), "r")) {
    char line[512];
    int steps = 0;  // of the loop that is measured
    while (std::fgets(line, sizeof line, output) != nullptr) {
      double number = 0.0;
      long balls = 0;
      if (std::sscanf(line, "Loop time of %lf on 1 procs for %d steps with %ld", &number, &steps,
                      &balls) == 3 &&
          steps == kTimedSteps) {
        run.seconds = number;
        run.balls = balls;
      }
      if (std::strstr(line, "% CPU use") != nullptr && std::sscanf(line, "%lf", &number) == 1 &&
          steps == kTimedSteps)
        run.seconds *= number / 100.0;
      if (std::sscanf(line, "pairs %lf", &number) == 1) run.pairs_per_ball = number;
    }
    pclose(output);
  }
  std::filesystem::remove(file);
  return run;
}

void step_of_a_melt_by_lammps(benchmark::State& state) {
  const LammpsRun run = run_lammps(state.range(0) != 0, state.range(1) != 0);
  if (run.balls == 0) {
    state.SkipWithError("no figures of LAMMPS: its program lmp is not installed, or failed");
    return;
  }
  for (auto _ : state) state.SetIterationTime(run.seconds / kTimedSteps);
  state.counters["per_ball"] = run.seconds / kTimedSteps / static_cast<double>(run.balls);
  state.counters["pairs_per_ball"] = run.pairs_per_ball;
}
BENCHMARK(step_of_a_melt_by_lammps)
    ->ArgNames({"drop", "opt"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1);

}  // namespace
