// tests/bench/peers/gromacs.cpp -- GROMACS, one thread of Debian's program `gmx`, mixed precision.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>

#include "tests/bench/peers/peer.h"

namespace cordis::bench {
namespace {

using std::filesystem::path;

// The units of the melt are those of argon.
constexpr double kSigma = 0.3405;  // [nm]
constexpr double kCut = 2.5 * kSigma;

void write_balls(const path& file) {
  const double spacing = 0.5 * kSigma * std::cbrt(4.0 / 0.8442);
  const double side = 2 * kMeltCells * spacing;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "w"), std::fclose);
  std::fprintf(out.get(), "melt\n%d\n", kMeltBalls);
  int number = 0;
  for (int z = 0; z < 2 * kMeltCells; ++z) {
    for (int y = 0; y < 2 * kMeltCells; ++y) {
      for (int x = (y + z) % 2; x < 2 * kMeltCells; x += 2) {
        ++number;
        std::fprintf(out.get(), "%5dAR      AR%5d%8.3f%8.3f%8.3f\n", number % 100000,
                     number % 100000, x * spacing, y * spacing, z * spacing);
      }
    }
  }
  std::fprintf(out.get(), "%10.5f%10.5f%10.5f\n", side, side, side);
}

/// 0.996 kJ/mol and 39.948 u: a time of 2.156 ps, a temperature of 119.8 K.
void write_model(const path& folder) {
  std::ofstream(folder / "melt.top") << R"([ defaults ]
1 1 no 1.0 1.0
[ atomtypes ]
AR 18 39.948 0.0 A )" << 4 * 0.996 * std::pow(kSigma, 6)
                                     << ' ' << 4 * 0.996 * std::pow(kSigma, 12) << R"(
[ moleculetype ]
AR 1
[ atoms ]
1 AR 1 AR AR 1 0.0 39.948
[ system ]
melt
[ molecules ]
AR )" << kMeltBalls << '\n';
  std::ofstream(folder / "melt.mdp")
      << "integrator = md\ndt = 0.01078\nnsteps = -1\n"
      << "cutoff-scheme = Verlet\nnstlist = 20\nrvdw = " << kCut << "\nrcoulomb = " << kCut << R"(
coulombtype = Cut-off
vdw-modifier = None
tcoupl = no
comm-mode = None
gen-vel = yes
gen-temp = 172.5
gen-seed = 87287
nstcalcenergy = 1000000
nstenergy = 0
nstlog = 0
nstxout-compressed = 0
)";
}

}  // namespace

std::vector<Peer> gromacs_on_a_melt(const path& folder) {
  if (!is_installed("gmx")) return {};
  write_balls(folder / "melt.gro");
  write_model(folder);
  const std::string in_folder = "cd " + folder.string() + " && gmx -nobackup ";
  if (processor_time_of(in_folder +
                        "grompp -f melt.mdp -c melt.gro -p melt.top -o melt.tpr -maxwarn 9") < 0.0)
    return {{"GROMACS: grompp failed", [] { return -1.0; }}};
  const auto command = [in_folder](int steps) {
    return in_folder + "mdrun -s melt.tpr -ntmpi 1 -ntomp 1 -pin off -nb cpu -noconfout -nsteps " +
           std::to_string(steps);
  };
  const std::string version = line_of("gmx --version", "GROMACS version");
  return {{"GROMACS " + version.substr(version.find_last_of(' ') + 1) +
               ", periodic box, mixed precision",
           [command] { return time_of_step(command, 100, 300) / kMeltBalls; }}};
}

}  // namespace cordis::bench
