// sim_node/asap_loop.cpp
#include "sim_node/asap_loop.h"

namespace cordis::sim {

void run_asap(SceneLoop& loop) {
  while (!loop.finished()) {
    if (loop.execute_or_wait()) loop.advance();
  }
}

}  // namespace cordis::sim
