"""How a figure that should stay level grows: the memory of a program that runs for months, or its descriptors."""
import statistics


def per_hour(samples):
    """The growth an hour of [(seconds, value)], as the median of the slopes between all pairs (Theil–Sen estimator), which
    single high readings do not move. It takes three samples or more."""
    if len(samples) < 3:
        raise ValueError(f"{len(samples)} samples say nothing about growth")
    slopes = [(v - u) / (t - s) for i, (s, u) in enumerate(samples) for t, v in samples[i + 1:] if t > s]
    return 3600 * statistics.median(slopes)


class Soak:
    """What was read of a program while it ran: [(seconds, KiB of memory of its own, descriptors)], and the bytes that it has
    logged. What comes before SETTLED seconds, when caches fill, is left out."""

    SETTLED = 600
    MOST_KIB_PER_HOUR = 512
    MOST_JOURNAL = 32 << 20  # bytes a day

    def __init__(self, samples, logged, seconds):
        self._samples = [each for each in samples if each[0] >= self.SETTLED]
        if len(self._samples) < 3:
            raise ValueError(f"{len(self._samples)} samples after {self.SETTLED} s say nothing")
        self._logged_per_day = logged * 86400 / seconds
        self._memory_per_hour = per_hour([(t, memory) for t, memory, _ in self._samples])

    def __str__(self):
        memory = [each[1] for each in self._samples]
        descriptors = [each[2] for each in self._samples]
        return (f"{len(self._samples)} samples over {(self._samples[-1][0] - self._samples[0][0]) / 60:.0f} minutes: memory of its "
                f"own {min(memory) / 1024:.1f} to {max(memory) / 1024:.1f} MiB, {self._memory_per_hour:+.0f} KiB an hour; "
                f"{min(descriptors)} to {max(descriptors)} descriptors; {self._logged_per_day / (1 << 20):.2f} MiB of log a day")

    def seconds(self):
        """What is judged, from its first sample to the last."""
        return self._samples[-1][0] - self._samples[0][0]

    def violations(self):
        """In words; empty if all is well."""
        found = []
        if self._memory_per_hour > self.MOST_KIB_PER_HOUR:
            found.append(f"memory grows by {self._memory_per_hour:.0f} KiB an hour")
        third = max(1, len(self._samples) // 3)
        before, after = (statistics.median(each[2] for each in part) for part in (self._samples[:third], self._samples[-third:]))
        if after > before:
            found.append(f"{before:.0f} descriptors were open, and then {after:.0f}")
        if self._logged_per_day > self.MOST_JOURNAL:
            found.append(f"{self._logged_per_day / (1 << 20):.0f} MiB of log a day")
        return found
