// viz_node/web/page/wire.ts -- numbers of the messages between processes that reach the page as
// they are: those of idl/, under the same names. A test keeps them equal.

export const MAX_AXES = 16;

export const LINK_IS_IDLE = 128;
export const MAX_BONDS = 16384;

export const MAT_MASS = 0;
export const MAT_FIXED = 1;
export const MAT_PORT = 2;
