// tests/support/pseudo_terminal.cpp
#include "tests/support/pseudo_terminal.h"

#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>

namespace cordis::test {

int open_board_end() {
  const int board = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  EXPECT_GE(board, 0);
  EXPECT_EQ(grantpt(board), 0);
  EXPECT_EQ(unlockpt(board), 0);
  return board;
}

int open_node_end(int board) {
  const int node = ::open(ptsname(board), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  EXPECT_GE(node, 0);
  termios line{};
  tcgetattr(node, &line);
  cfmakeraw(&line);
  tcsetattr(node, TCSANOW, &line);
  return node;
}

}  // namespace cordis::test
