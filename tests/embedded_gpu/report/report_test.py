#!/usr/bin/env python3
"""Tests of the report's parts that need no driver; called by CTest."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True

import compiling  # noqa: E402
import cost  # noqa: E402
import programs  # noqa: E402
import recording  # noqa: E402
import shader_statistics  # noqa: E402
import tables  # noqa: E402

V3D = ("MESA_SHADER_COMPUTE shader: 4057 inst, 2 threads, 9 loops, 203 uniforms, 60 max-temps, "
       "100:338 spills:fills, 12 sfu-stalls, 4069 inst-and-stalls, 80 nops")
MALI = ("MESA_SHADER_FRAGMENT shader: 6510 inst, 2200 tuples, 900 clauses, 92.5 cycles, 40.25 arith, 3.5 texture, "
        "0.125 vary, 92.5 ldst, 560 quadwords, 1 threads, 4 loops, 2101:2823 spills:fills")
ADRENO = ("FRAG shader: 1990 inst, 300 nops, 1690 non-nops, 44 mov, 3 cov, 2048 dwords, 0 last-baryf, 0 last-helper, "
          "2 half, 48 full, 12 constlen, 8 cat0, 8 stp, 13 ldp, 20 sstall, 12 (ss), 5 systall, 4 (sy), 4 waves, 1 loops")


def statistics(**changes):
    """Those of V3D's line, with changes."""
    values = {"stage": "compute", "instructions": 400, "threads": 4, "registers": 20, "spills": 0, "fills": 0,
              "loops": 1, "cycles": None}
    return shader_statistics.Statistics(**(values | changes))


def record(program, flag=None, texture="rgba8"):
    return {"program": program, "defines": [flag] if flag else [], "state": {"textures": {"picture": texture}},
            "work": {}, "count": 1}


class Parsing(unittest.TestCase):
    def test_reads_v3d(self):
        self.assertEqual(shader_statistics.parsed(V3D), statistics(
            instructions=4057, threads=2, registers=60, spills=100, fills=338, loops=9))

    def test_reads_mali(self):
        one = shader_statistics.parsed(MALI)
        self.assertEqual((one.stage, one.instructions, one.threads, one.spills, one.fills, one.cycles),
                         ("fragment", 6510, 1, 2101, 2823, 92.5))

    def test_reads_adreno(self):
        one = shader_statistics.parsed(ADRENO)
        self.assertEqual((one.stage, one.instructions, one.threads, one.registers, one.spills, one.fills),
                         ("fragment", 1990, 4, 48, 8, 13))

    def test_ignores_other_messages(self):
        self.assertIsNone(shader_statistics.parsed("Shader cache is disabled"))

    def test_takes_the_worst_variant(self):
        other = V3D.replace("4057 inst, 2 threads", "99 inst, 4 threads")
        worst = shader_statistics.worst_by_stage([other, V3D, other])
        self.assertEqual((worst["compute"].instructions, worst["compute"].threads), (4057, 2))


class Regressions(unittest.TestCase):
    @staticmethod
    def complaints(**changes):
        kept = {"compute": tables.Row("", statistics())}
        return tables.regressions(kept, compiling.Compiled({"compute": statistics(**changes)}, 1.0, ""))

    def test_lets_equal_and_better_ones_pass(self):
        self.assertEqual(self.complaints(), [])
        self.assertEqual(self.complaints(instructions=300, registers=12), [])
        self.assertEqual(self.complaints(instructions=440), [])

    def test_tells_of_spills_threads_and_growth(self):
        self.assertIn("spills 0:1, before 0:0", self.complaints(fills=1)[0])
        self.assertIn("2 threads, before 4", self.complaints(threads=2)[0])
        self.assertIn("441 instructions, before 400", self.complaints(instructions=441)[0])

    def test_tells_of_failures_and_of_what_is_not_kept(self):
        self.assertEqual(tables.regressions({}, compiling.Compiled({}, 1.0, "does not link")), ["does not link"])
        self.assertIn("not in the table",
                      tables.regressions({}, compiling.Compiled({"compute": statistics()}, 1.0, ""))[0])


class Programs(unittest.TestCase):
    def test_names_them_by_folder_file_and_flags(self):
        label = "pipeline/gpu/shaders/fullscreen.vert pipeline/styles/watercolor/shaders/compose.frag MOSAIC"
        self.assertEqual(programs.name(record(label)), "watercolor: compose.frag MOSAIC")

    def test_keeps_each_state_once(self):
        a, b = record("pipeline/a/shaders/a.comp"), record("pipeline/a/shaders/a.comp", texture="r32f")
        self.assertEqual(len(programs.distinct([a, b, a])), 2)

    def test_tells_of_what_is_missing(self):
        a, b = record("pipeline/a/shaders/a.comp"), record("pipeline/a/shaders/b.comp")
        self.assertEqual(recording.missing([a, b], [b]), [])
        self.assertIn("a: b.comp", recording.missing([a], [a, b])[0])

    def test_strips_comments(self):
        self.assertEqual(programs.without_comments("// a\nfloat b; // c\n\n  /* d\n e */ f\n"), "float b;\nf")



class Costs(unittest.TestCase):
    @staticmethod
    def dispatch(groups, size):
        return {"program": "pipeline/a/shaders/b.comp", "defines": [], "state": {"textures": {"t": "rgba8"}, "images": {}},
                "work": {"groups": groups, "group_size": size, "textures": {"t": [640, 480, 4]}, "images": {}}, "count": 4}

    def test_lists_read_what_is_around_their_members(self):
        one = cost.passes_of([], [self.dispatch([2, 1, 1], [64, 1, 1])], 4)["a: b.comp"]
        self.assertEqual(one.read, [4 * 128, 4 * 128 * cost.LIST_TEXELS])
        self.assertEqual(one.invocations["compute"], [128, 128])

    def test_listed_groups_write_only_where_they_are(self):
        listed = self.dispatch([3, 1, 1], [8, 8, 1])
        listed["work"]["listed"] = True
        listed["work"]["images"]["i"] = [640, 480, 4]
        listed["state"]["images"]["i"] = ["rgba8", 0x88B9]
        one = cost.passes_of([], [listed], 4)["a: b.comp"]
        self.assertEqual(one.written, [4 * 192, 4 * 192])
        self.assertEqual(one.read, [4 * 192, 4 * 192 * cost.LIST_TEXELS])

    def test_grids_read_whole_textures(self):
        one = cost.passes_of([], [self.dispatch([10, 30, 1], [16, 4, 1])], 4)["a: b.comp"]
        self.assertEqual(one.read, [4 * 640 * 480, 8 * 640 * 480])

    def test_draws_of_a_program_cover_the_target_together(self):
        draw = {"program": "pipeline/a/shaders/b.vert pipeline/a/shaders/b.frag", "defines": [], "state": {"textures": {}},
                "work": {"viewport": [10, 10], "vertices": 3, "instances": 1, "targets": [[10, 10, 4]], "depth": [10, 10, 4],
                         "textures": {}}, "count": 8}
        one = cost.passes_of([], [draw], 4)["a: b.frag"]  # two a frame
        self.assertEqual(one.invocations["fragment"], [0.1 * 100, 2.0 * 100])
        self.assertEqual(one.written, [0.1 * 800, 2.0 * 800])

    def test_a_frame_is_the_difference_of_two_runs(self):
        start = self.dispatch([10, 30, 1], [16, 4, 1])
        self.assertEqual(cost.passes_of([start], [start], 4), {})

    def test_computing_and_moving_overlap_at_best(self):
        one = cost.passes_of([], [self.dispatch([10, 30, 1], [16, 4, 1])], 4)["a: b.comp"]
        board = cost.Board("board", "none", 1e6, None, (1e6, 2e6))
        row = tables.Row("-", statistics(instructions=100, spills=0, fills=0, loops=0))
        least, most = cost.seconds_on(board, one, {"compute": row})
        self.assertAlmostEqual(least, 100 * 19200 / 1e6)
        self.assertAlmostEqual(most, 100 * 19200 / 1e6 + 8 * 640 * 480 / 1e6)


if __name__ == "__main__":
    unittest.main()
