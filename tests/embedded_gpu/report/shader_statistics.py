"""What the drivers' compilers say of a shader, in one shape for all drivers."""
import dataclasses
import re

# "MESA_SHADER_COMPUTE shader: 83 inst, 4 threads, …" (V3D, Mali, Adreno)
LINE = re.compile(r"(?:MESA_SHADER_)?(\w+) shader: (\d+ inst\b.*)")
STAGES = {"VERTEX_BIN": "bin", "COORD": "bin", "BVERT": "bin", "VERTEX": "vertex", "VERT": "vertex", "VS": "vertex",
          "FRAGMENT": "fragment", "FRAG": "fragment", "FS": "fragment", "COMPUTE": "compute", "COMP": "compute",
          "CL": "compute", "CS": "compute", "KERNEL": "compute"}


@dataclasses.dataclass(frozen=True)
class Statistics:
    """Counts of one compiled shader. Fields that a driver does not tell are None."""
    stage: str
    instructions: int
    threads: int | None  # side by side on a core: fewer where registers run short; of Adreno, waves
    registers: int | None  # of V3D temporaries at most, of Adreno full registers of four
    spills: int  # stores of registers to memory
    fills: int  # loads of them
    loops: int
    cycles: float | None  # Mali: of the slowest unit, each loop once

    def worse(self, other):
        """The worse of two variants of one shader, count by count."""
        def pick(choose, a, b):
            known = [value for value in (a, b) if value is not None]
            return choose(known) if known else None
        return Statistics(self.stage, *(pick(min if field.name == "threads" else max, getattr(self, field.name),
                                             getattr(other, field.name))
                                        for field in dataclasses.fields(self)[1:]))


def parsed(message):
    """The Statistics in a driver's message, or None."""
    match = LINE.search(message)
    if not match:
        return None
    counts = {name: float(value) if "." in value else int(value)
              for value, name in re.findall(r"([\d.]+) ([a-z(][\w()+-]*)", match[2])}
    spills, fills = counts.get("stp", 0), counts.get("ldp", 0)
    if spilled := re.search(r"(\d+):(\d+) spills:fills", match[2]):
        spills, fills = int(spilled[1]), int(spilled[2])
    stage = match[1].upper()
    return Statistics(STAGES.get(stage, stage.lower()), counts["inst"], counts.get("threads", counts.get("waves")),
                      counts.get("max-temps", counts.get("full")), spills, fills, counts.get("loops", 0),
                      counts.get("cycles"))


def worst_by_stage(messages):
    """{stage: Statistics}, over all variants that the messages tell of."""
    worst = {}
    for message in messages:
        if one := parsed(message):
            worst[one.stage] = worst[one.stage].worse(one) if one.stage in worst else one
    return worst
