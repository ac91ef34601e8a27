#pragma once
#include <stdexcept>

namespace dmf {

/// What a user asked for can't be done. `what()` names the thing, its value and what is allowed; one line a
/// violation. Nothing has changed when it is thrown.
class InvalidInput : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace dmf
