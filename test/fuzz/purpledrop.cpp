// A board definition of PurpleDrop.
#include "board.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return try_board(data, size, "fuzz.json");
}
