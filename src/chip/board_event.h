#pragma once
#include <cstdint>
#include <string>

namespace dmf::chip {

/// Something that happened to the board, at the step before which it did.
struct BoardEvent {
  enum class Kind {
    halted,          ///< the rail, by a command or by the board's protection
    fault_injected,  ///< or taken away
  } kind;
  std::uint64_t step;
  std::string message;  ///< for people
};

}  // namespace dmf::chip
