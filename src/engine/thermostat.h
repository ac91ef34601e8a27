#pragma once
#include "engine/beads.h"
#include "engine/forces.h"
#include "engine/pairs.h"
#include "engine/parameters.h"
#include "engine/walls/walls.h"

namespace dmf::engine {

/// Friction and noise of all pairs for one time step with positions held: the O of BAOAB.
///
/// Let D be the matrix that turns velocities into friction forces, f = -D v: symmetric, positive, a sum over
/// pairs of gamma w_c^2 e e^T, so that every product with it conserves momentum. With A = dt/2 D and the
/// random impulses N, whose covariance is 4 A k_BT, the step is
///
///   v+ = P v + Q N,   P = 1 - 2 A (1 - b A),   Q = 1 - (1 + b)/2 A + (b - (1 + b)^2 / 8) A^2,   b = 0.8
///
/// in two products with D. The Maxwell distribution stays as it is when P^2 + 4 A Q^2 = 1. The implicit
/// midpoint rule, P = (1 - A)/(1 + A), Q = 1/(1 + A), fulfils that exactly, and gives single beads the
/// mobility of the continuous equation, but needs a linear system solved at every step. P here stays close to
/// it over most eigenvalues of A (their mean is 7.6 dt in this liquid: 0.15 at dt = 0.02), b chosen for the
/// mobility, and Q follows from the condition up to A^2. Temperature of a mode: 0.9995 at A = 0.2, 0.9989 at
/// 0.4, 1.014 at 0.6; mobility: 0.99, 1.07, 1.32.
///
/// All pairs go at once, so the result does not depend on an order of pairs. Schemes that go pair by pair
/// (Shardlow 2003, Peters 2004) give the same temperatures but would need one.
///
/// Needs the noise keys of the step; leaves densities of these positions, `beads.force` and
/// `beads.predicted` undefined.
void thermostat(Beads& beads, const Walls& wall, Microparticles& bodies, Pairs& pairs, const Forces& forces,
                const Parameters& parameters);

}  // namespace dmf::engine
