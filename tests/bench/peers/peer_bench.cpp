// tests/bench/peers/peer_bench.cpp -- Cordis beside other programs, in one table.
//
// usage: peer_bench [ROUNDS]; takes the programs that are installed: Debian's lammps, gromacs, libbullet-dev
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include <unistd.h>

#include "cli/bench/bench_networks.h"
#include "cli/bench/plain_loop.h"
#include "sim_node/engine/world.h"
#include "sim_node/plan/reference/thread_time.h"
#include "tests/bench/bench_scenes.h"
#include "tests/bench/peers/peer.h"

namespace {

using cordis::bench::kMeltBalls;
using cordis::bench::kNetLinks;
using cordis::bench::Peer;
using cordis::bench::PeerScene;
using cordis::engine::Network;
using cordis::engine::VectorWidth;
using cordis::engine::World;

/// @param steps  timed at once
template <class Loop>
double time_of_steps(Loop& loop, int steps) {
  const double begin = cordis::plan::thread_nsec();
  for (int n = 0; n < steps; ++n) loop.step();
  return 1e-9 * (cordis::plan::thread_nsec() - begin) / steps;
}

std::vector<Peer> ours(const std::shared_ptr<const Network>& network, int steps, int elements) {
  std::vector<Peer> peers;
  for (const VectorWidth width : cordis::engine::supported_vector_widths()) {
    const auto world = std::make_shared<World>(network, width);
    for (int n = 0; n < 100; ++n) world->step();
    peers.push_back({std::string("Cordis, ") + to_string(width),
                     [world, steps, elements] { return time_of_steps(*world, steps) / elements; }});
  }
  std::reverse(peers.begin(), peers.end());  // the widest first
  return peers;
}

void add(std::vector<Peer>& peers, std::vector<Peer> more) {
  for (Peer& peer : more) peers.push_back(std::move(peer));
}

PeerScene net(const std::filesystem::path& folder) {
  const auto description = cordis::cli::square_net(3, cordis::bench::kNetSide);
  PeerScene scene{"net of 19,800 springs in 3-D", "link", {}};
  scene.peers = ours(std::make_shared<const Network>(description), 2000, kNetLinks);
  const auto loop = std::make_shared<cordis::cli::PlainLoop>(description);
  scene.peers.push_back(
      {"plain C++ loop", [loop] { return time_of_steps(*loop, 1000) / kNetLinks; }});
  add(scene.peers, cordis::bench::lammps_on_a_net(folder));
  add(scene.peers, cordis::bench::bullet_on_a_net());
  return scene;
}

PeerScene melt(const std::filesystem::path& folder) {
  PeerScene scene{"melt of 32,000 balls", "ball", {}};
  scene.peers = ours(cordis::bench::melt(cordis::bench::kMeltCells), 100, kMeltBalls);
  add(scene.peers, cordis::bench::lammps_on_a_melt(folder));
  add(scene.peers, cordis::bench::gromacs_on_a_melt(folder));
  return scene;
}

/// Rounds of all peers in turns, so that what slows the machine for a while slows all of them.
void print_rows(const PeerScene& scene, int rounds) {
  std::vector<std::vector<double>> times(scene.peers.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < scene.peers.size(); ++i) times[i].push_back(scene.peers[i].time());
  }
  double first = 0.0;
  for (std::size_t i = 0; i < scene.peers.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    const double median = times[i][times[i].size() / 2];
    if (i == 0) first = median;
    const char* const name = scene.peers[i].name.c_str();
    if (median < 0.0) {
      std::printf("| %s | %s | failed | |\n", scene.name.c_str(), name);
    } else {
      std::printf("| %s | %s | %.3g ns a %s | %.2f |\n", scene.name.c_str(), name, 1e9 * median,
                  scene.element.c_str(), median / first);
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("cordis_peers_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::printf("%s; one thread, processor time, medians of %d rounds in turns\n\n",
              cordis::bench::line_of("cat /proc/cpuinfo", "model name").c_str(), rounds);
  std::printf("| scene | program | a step | times Cordis |\n| --- | --- | --- | --- |\n");
  print_rows(net(folder), rounds);
  print_rows(melt(folder), rounds);
  std::filesystem::remove_all(folder);
}
