#include "engine/wait_policy.h"

#include <unistd.h>

#include <cstdlib>

namespace dmf::engine {

void prefer_short_spinning(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("GOMP_SPINCOUNT", "1000", 1);
  // When the program can't be started again it runs on as it is: slower on a busy machine, but right.
  execv("/proc/self/exe", arguments);
}

}  // namespace dmf::engine
