// tests/support/pseudo_terminal.h -- a serial line of which a test is the board.
#pragma once

namespace cordis::test {

/// Opens a new pseudo-terminal. @return the end of the board, which never waits
int open_board_end();

/// Opens the end of a node, and sets it to raw bytes.
/// @param board  from open_board_end()
int open_node_end(int board);

}  // namespace cordis::test
