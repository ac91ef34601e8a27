#include "engine/wait_policy.h"

#include <unistd.h>

#include <cstdlib>

namespace dmf::engine {

void prefer_sleeping_threads(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);
  // When the program can't be started again it runs on as it is: slower on a busy machine, but right.
  execv("/proc/self/exe", arguments);
}

}  // namespace dmf::engine
