"""bench.py reads what Google Benchmark and LAMMPS print, and compares what belongs together."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "bench"))
from bench import Case, Samples, Unusable, parse_lammps, parse_name

LAMMPS_LOG = """\
Created 3159 atoms
Loop time of 1.66325 on 1 procs for 100 steps with 85719 atoms

Performance: 51946.491 tau/day, 60.123 timesteps/s
moving beads 3159
Setting up Verlet run ...
Loop time of 6.51823 on 1 procs for 400 steps with 85719 atoms
"""


class Parsing(unittest.TestCase):
    def test_a_benchmark_is_named_by_workload_kernel_and_threads(self):
        self.assertEqual(parse_name("W1_bulk_20/avx512/threads:12/iterations:82/real_time"),
                         Case("W1_bulk_20", "avx512", 12, "default"))

    def test_lammps_cost_is_that_of_the_last_run_and_of_moving_beads_only(self):
        ns, beads = parse_lammps(LAMMPS_LOG)
        self.assertEqual(beads, 3159)
        self.assertAlmostEqual(ns, 6.51823e9 / 400 / 3159)

    def test_a_lammps_run_that_ends_early_says_why(self):
        log = LAMMPS_LOG[:LAMMPS_LOG.index("Setting up")] + "ERROR: Lost atoms: original 85719 current 85718\n"
        with self.assertRaisesRegex(Unusable, "Lost atoms"):
            parse_lammps(log)


class Comparison(unittest.TestCase):
    def test_ratios_are_to_the_same_workload_with_one_thread(self):
        samples = Samples()
        for workload, factor in (("W1_bulk_20", 1), ("W2_droplet_R10", 2)):
            for ns in (90, 100, 130):
                samples.add(Case(workload, "avx2", 1, "default"), ns * factor, 1000)
            samples.add(Case(workload, "avx2", 2, "active"), 50 * factor, 1000)
            samples.add(Case(workload, "reference", 1, "default"), 3000 * factor, 1000)
            samples.add(Case(workload, "lammps", 1, "default"), 700 * factor, 1010)
        for row in samples.rows():
            if row["kernel"] == "avx2":
                one_thread = row["threads"] == 1
                self.assertEqual(row["reference_over_this"], 30 if one_thread else 60)
                self.assertEqual(row["lammps_over_this"], 7 if one_thread else 14)
                self.assertEqual(row["one_thread_over_this"], None if one_thread else 2)


if __name__ == "__main__":
    unittest.main()
