#pragma once

namespace dmf::engine {

/// Lets OpenMP threads spin only for some microseconds before they sleep while they wait for each other,
/// unless OMP_WAIT_POLICY or GOMP_SPINCOUNT is set. Spinning without end is fastest on a machine of one's
/// own, but on a busy one a spinning thread takes the time that the thread it waits for needs, and a step
/// takes ten times as long; docs/performance.md has the figures. OpenMP reads the setting when the program is
/// loaded, so this starts the program again; call it first thing in main().
/// @param arguments  argv.
void prefer_short_spinning(char** arguments);

}  // namespace dmf::engine
