// tests/bench/peers/lammps.cpp -- LAMMPS, one thread of Debian's program `lmp`.
#include <algorithm>
#include <fstream>

#include "tests/bench/peers/peer.h"

namespace cordis::bench {
namespace {

using std::filesystem::path;

constexpr const char* kProgram = "OMP_NUM_THREADS=1 lmp -log none";

std::string version() {
  const std::string line = line_of("lmp -h", "Parallel Simulator - ");
  return "LAMMPS " + line.substr(std::min(line.size(), line.find(" - ") + 3));
}

/// The net of square_net(): its springs alone, for a harmonic bond has no viscosity.
void write_net(const path& file) {
  std::ofstream data(file);
  data << "a net\n\n"
       << kNetSide * kNetSide << " atoms\n"
       << kNetLinks << " bonds\n"
       << "1 atom types\n1 bond types\n-1 2 xlo xhi\n-1 2 ylo yhi\n-1 1 zlo zhi\n\n"
       << "Masses\n\n1 0.01\n\nAtoms # bond\n\n";
  for (int i = 0; i < kNetSide * kNetSide; ++i) {
    data << i + 1 << " 1 1 " << 0.01 * (i % kNetSide) << ' ' << 0.01 * (i / kNetSide) << " 0\n";
  }
  data << "\nBonds\n\n";
  int bond = 0;
  for (int i = 0; i < kNetSide * kNetSide; ++i) {
    if (i % kNetSide + 1 < kNetSide) data << ++bond << " 1 " << i + 1 << ' ' << i + 2 << '\n';
  }
  for (int i = 0; i + kNetSide < kNetSide * kNetSide; ++i)
    data << ++bond << " 1 " << i + 1 << ' ' << i + 1 + kNetSide << '\n';
}

/// A bond has the energy 50 (r - 0.0099)^2: 100 N/m.
std::string net_input(const path& data) {
  return "units lj\natom_style bond\nboundary f f f\nread_data " + data.string() + R"(
comm_modify cutoff 0.1
bond_style harmonic
bond_coeff 1 50.0 0.0099
fix 1 all nve
timestep 0.001
thermo 1000000
run ${steps}
)";
}

/// bench/in.lj of LAMMPS. @param drop  in free space, as in bench_scenes.h, instead of a periodic box
std::string melt_input(bool drop) {
  return std::string(drop ? "boundary s s s\n" : "") + R"(units lj
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
thermo 1000000
run ${steps}
)";
}

/// @param many  steps of the longer run, beside 100 in which the caches warm and the lattice melts
Peer lammps(const std::string& name, const path& file, const std::string& input,
            const std::string& words, int many, int elements) {
  std::ofstream(file) << input;
  const auto command = [file, words](int steps) {
    return std::string(kProgram) + words + " -var steps " + std::to_string(steps) + " -in " +
           file.string();
  };
  return {name + words,
          [command, many, elements] { return time_of_step(command, 100, 100 + many) / elements; }};
}

}  // namespace

std::vector<Peer> lammps_on_a_net(const path& folder) {
  if (!is_installed("lmp")) return {};
  write_net(folder / "net.data");
  return {lammps(version() + ", harmonic bonds without viscosity", folder / "net.in",
                 net_input(folder / "net.data"), "", 4000, kNetLinks)};
}

std::vector<Peer> lammps_on_a_melt(const path& folder) {
  if (!is_installed("lmp")) return {};
  std::vector<Peer> peers;
  for (const bool drop : {true, false}) {
    for (const char* words : {"", " -suffix opt"}) {
      peers.push_back(lammps(version() + (drop ? ", the same drop" : ", periodic box"),
                             folder / (drop ? "drop.in" : "box.in"), melt_input(drop), words, 200,
                             kMeltBalls));
    }
  }
  return peers;
}

}  // namespace cordis::bench
