// tests/bench/peers/peer.h -- other programs that step the scenes of Cordis.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cordis::bench {

/// What steps a scene, and how its time is found.
struct Peer {
  std::string name;
  /// Processor time of one step for each link or ball [s]; below 0 where the program fails.
  std::function<double()> time;
};

/// The peers of one scene.
struct PeerScene {
  std::string name;
  std::string element;  ///< "link" or "ball"
  std::vector<Peer> peers;
};

/// A net of 100 x 100 masses in 3-D and its 19,800 springs: each side of it.
inline constexpr int kNetSide = 100;
inline constexpr int kNetLinks = 2 * kNetSide * (kNetSide - 1);
/// The melt of bench_scenes.h: its balls, and cells along an edge.
inline constexpr int kMeltCells = 20;
inline constexpr int kMeltBalls = 4 * kMeltCells * kMeltCells * kMeltCells;

/// True if a program can be started.
bool is_installed(const std::string& program);
/// The first line that a command prints with these words in it; empty without one.
std::string line_of(const std::string& command, const std::string& words);
/// Processor time of a command and all that it starts [s]; below 0 when it fails. What it prints is lost.
double processor_time_of(const std::string& command);
/// Time of one step from the processor time of a run of many steps less that of a few; below 0 when one fails [s].
/// @param command  of a run of so many steps
double time_of_step(const std::function<std::string(int steps)>& command, int few, int many);

/// Peers that are installed. @param folder  for their files, empty
std::vector<Peer> lammps_on_a_net(const std::filesystem::path& folder);
std::vector<Peer> lammps_on_a_melt(const std::filesystem::path& folder);
std::vector<Peer> gromacs_on_a_melt(const std::filesystem::path& folder);
std::vector<Peer> bullet_on_a_net();

}  // namespace cordis::bench
