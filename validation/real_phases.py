"""Phases of real records: what is true of each, and what palpate finds.

    python validation/real_phases.py "$PALPATE_DATA"            prints the table
    python validation/real_phases.py "$PALPATE_DATA" --write    also writes docs/validation/phases.md
    python validation/real_phases.py "$PALPATE_DATA" --palpate target/debug/palpate

The expected values were written by hand from the metadata of the records and a look at their plots. D is a hold of the displacement, F
a hold of the force; the order is that of the record. Without a description every record is read as it is; where a file states no units,
`--columns` does. `=` stands for as many as the record has, where only their kind is known.
"""

import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
GRIPPER = ["--columns", "time=Time:s,displacement=Pos:mm,force=Force:N"]
SILICONE = ["--test", str(ROOT / "examples/tests/silicone-steps.toml")]
TITIN = ["--test", str(ROOT / "validation/records/titin.toml")]
MODULUS = ["--columns", "time=1:s,modulus=2:Pa"]
COMPLIANCE = ["--columns", "time=1:s,compliance=2:1/Pa"]
# A step in strain after each peak; the peak holds of 3 s end with a rotor that stands.
TRIOS = {f"{name} - {n}": "D" for name, numbers in (("Stress relaxation", (7, 11, 15, 19)), ("Peak hold", (10, 14, 18))) for n in numbers}
TRIOS |= {"Flow sweep - 4": "a flow curve"}
# Its amplitude stands at 0 in one interval; two others are flow curves.
ANTON_PAAR = {
    "LAOS 1, interval 2": "the force is 0 N in all 30 rows: there is no relaxation",
    "Flow Curve 1, interval 3": "a flow curve",
    "Flow Curve 1, interval 4": "a flow curve",
}
SHEAR = ["--columns", "time=1:s,force=2:N,displacement=3:mm"]
ZWICK = {f"230515-P002-{n}": "D F" for n in (1, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13)}

# File, further arguments, and what is true: holds in their order, "none", or a word per test of the file.
EXPECTED = [
    ("afm-jpk/fmt-jpk-sr_cell1-0008.jpk-force", [], "D"),
    ("afm-jpk/force-save-multi1.txt.gz", [], "D D D D"),
    ("creep/CM3_Creep.creep", [], "F"),
    ("creep/CM3_CreepRecovery.creep", [], "F"),
    ("creep/HC1_stressrelaxation_20C_5.csv", [], "D"),
    ("creep/creep_perihepatic_data.csv", COMPLIANCE, "F"),
    ("foam/XtraSoft.csv", [], "D"),
    ("gripper-fruit/banana_ForceData_20240824_210940_refined.csv", GRIPPER, "F F F"),
    ("gripper-fruit/kiwi_ForceData_20241127_224354_refined.csv", GRIPPER, "none"),
    ("silicone-steps/1_10_E4pin_20mm_v7.csv", SILICONE, "none"),
    ("silicone-steps/1_7-5_Epin_20mm_v1.csv", SILICONE, "D " * 24),
    ("silicone-steps/2_7-5_E2pin_20mm_capac_relax.csv", SILICONE, "D " * 9),
    ("tendon/fresh_1.csv", [], "D"),
    ("titin-ramps/AvgRelaxed_0.1s.csv", TITIN, "D"),
    ("titin-ramps/AvgRelaxed_1s.csv", TITIN, "D"),
    ("titin-ramps/AvgRelaxed_10s.csv", TITIN, "D"),
    ("titin-ramps/AvgRelaxed_100s.csv", TITIN, "D"),
    ("vhb4910/cyc_0d05_2d5_2.csv", [], "none"),
    ("vhb4910/relax_2d5.csv", [], "D"),
    ("vhb4910/relax_3d0.csv", [], "D"),
    ("zwick-indentation/230403_C_Indentation_relaxation_500N_force.xlsx", [], {None: "D"}),
    ("zwick-indentation/230515_C_Indentation_relaxation_500N_force.xls", [], {None: "D"}),
    ("more/afm/JPK-2h.txt.gz", [], "none"),
    ("more/afm/force-save-1.txt.gz", [], "none"),
    ("more/afm/fmt-chiaro-txt_AEBP1_Indentation_002.zip", [], "none"),
    ("more/afm/fmt-tab-fd_version_0.13.3.tab", [], "none"),
    ("more/afm/fmt-hdf5-fd_version_0.13.3.h5", [], "none"),
    ("more/afm/fmt-igor-fd_SiN_FD_plot.ibw", [], "none"),
    ("more/afm/fmt-jpk-fd_map2x2_extracted.jpk-force-map", [], {None: "none"}),
    *((f"more/afm/cell1-{n}.jpk-force", [], "D") for n in ("0001", "0002", "0005", "0009", "0012")),
    ("more/gripper-fruit/banana_20241113_143619.csv", GRIPPER, "D"),
    ("more/mts/i0_1.5_1_ramp.txt", [], "none"),
    ("more/mts/i0_1.5_1_hold.txt", [], "D"),
    ("more/mts/i0_1.5_1_ramp.txt", ["--then", "more/mts/i0_1.5_1_hold.txt"], "D"),
    ("more/mts/i8_3_1_ramp.txt", [], "none"),
    ("more/mts/i8_3_1_hold.txt", [], "D"),
    ("more/mts/i8_3_1_ramp.txt", ["--then", "more/mts/i8_3_1_hold.txt"], "D"),
    ("more/nanoindentation/agilent_example.xls", [], {None: "F F"}),
    ("more/rheometer/anton_paar.csv", [], ANTON_PAAR),
    ("more/rheometer/creep_mucus.csv", COMPLIANCE, "F"),
    ("more/rheometer/relaxation_fishmuscle.csv", MODULUS, "D"),
    ("more/rheometer/relaxation_hdpe.csv", MODULUS, "D"),
    ("more/rheometer/relaxation_ps145.csv", MODULUS, "D"),
    ("more/rheometer/trios_steps.txt", [], TRIOS),
    ("more/tendon/G1_1.csv", [], "D"),
    ("more/tendon/G1_2.csv", [], "D"),
    ("more/vhb4910/relax_2d0.csv", [], "D"),
    ("more/vhb4910/relax_3d5.csv", [], "D"),
    ("more/vhb4910/shear_relaxation_1.xlsx", SHEAR, "D D D D"),
    ("more/zwick-indentation/maintienFnulle.xls", [], ZWICK),
]
LETTERS = {"displacement": "D", "force": "F", "neither": "N"}


def inspect(palpate, data, file, arguments):
    """The text of `palpate inspect`, and what it says of errors."""
    run = subprocess.run(
        [palpate, "inspect", file, *arguments], cwd=data, capture_output=True, text=True, timeout=600, check=False
    )
    return run.stdout, run.stderr


def phases(text, errors):
    """The holds of one test in their order, "none", or why there is no record."""
    holds = re.findall(r"^hold +(displacement|force|neither)\b", text, re.MULTILINE)
    if holds:
        return " ".join(LETTERS[hold] for hold in holds)
    if re.search(r"^Phases: .*(no hold|no motion)", text, re.MULTILINE):
        return "none"
    first = next((line for line in errors.splitlines() if line.startswith("error:")), "error: no phases")
    if "found a flow curve" in first:
        return "a flow curve"
    return first.removeprefix("error: ").split(": ", 1)[-1][:90]


def tests(palpate, data, file, arguments):
    """Each test of a file with what is found in it."""
    text, errors = inspect(palpate, data, file, arguments)
    if "\nTests\n" not in text:
        return {None: phases(text, errors)}
    # The rows lie between the second and the third rule; a wide table goes on below.
    body = re.split(r"^─+$", text.split("\nTests\n")[1], flags=re.MULTILINE)[2]
    names = [line.split("  ")[0].strip() for line in body.strip().splitlines()]
    return {name: phases(*inspect(palpate, data, file, [*arguments, "--part", name])) for name in names}


def shown(holds):
    """Holds as a table shows them: D D D D is 4 D."""
    parts = []
    for letter in holds.split():
        if parts and parts[-1][1] == letter:
            parts[-1][0] += 1
        else:
            parts.append([1, letter])
    if holds == "none" or any(letter not in "DFN" for _, letter in parts):
        return holds
    return ", ".join(letter if count == 1 else f"{count} {letter}" for count, letter in parts)


def rows(palpate, data):
    """A row per record, or per kind of test in a file of several: name, expected, found, right."""
    for file, arguments, truth in EXPECTED:
        then = f" then {pathlib.Path(arguments[1]).name}" if arguments[:1] == ["--then"] else ""
        found = tests(palpate, data, file, arguments)
        if isinstance(truth, str):
            outcome = found.get(None, f"{len(found)} tests")
            yield f"{file}{then}", shown(truth.strip()), shown(outcome), outcome.split() == truth.split()
            continue
        expected = {name: truth.get(name, truth.get(None, "none")) for name in {*found, *truth} - {None}}
        right = [name for name in expected if found.get(name, "").split() == expected[name].split()]
        wrong = {name: found.get(name, "no test") for name in expected if name not in right}
        kinds = sorted({shown(value) for value in expected.values()})
        outcome = f"{len(right)} of {len(expected)} tests" + "".join(f"; {n}: {shown(v)}" for n, v in wrong.items())
        yield file, f"{len(expected)} tests: {' or '.join(kinds)}", outcome, not wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--palpate", default=str(ROOT / "target/release/palpate"))
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    palpate = str(pathlib.Path(options.palpate).resolve())
    lines = ["| record | expected | found | |", "|---|---|---|---|"]
    right = total = 0
    for name, expected, found, is_right in rows(palpate, options.data):
        lines.append(f"| {name} | {expected} | {found} | {'' if is_right else '**differs**'} |")
        right, total = right + is_right, total + 1
    table = "\n".join([*lines, "", f"{right} of {total} rows agree."])
    print(table)
    if options.write:
        page = ROOT / "docs/validation/phases.md"
        head = page.read_text().split("<!-- table -->")[0]
        page.write_text(f"{head}<!-- table -->\n\n{table}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
