#pragma once

namespace dmf::engine {

/// Makes OpenMP threads sleep instead of spin while they wait for each other, unless OMP_WAIT_POLICY or
/// GOMP_SPINCOUNT is set. On a machine that is busy with something else a spinning thread takes the time that
/// the thread it waits for needs: a step of a small droplet on two threads took four times as long. OpenMP
/// reads the setting when the program is loaded, so this starts the program again; call it first thing in
/// main().
/// @param arguments  argv.
void prefer_sleeping_threads(char** arguments);

}  // namespace dmf::engine
