"""The program runs in the guest as it was built: with the guest's libraries, Mesa and kernel."""


def run(guest):
    styles = guest.run("./pleinair styles", seconds=30)
    assert "watercolor" in styles.output, styles.output
    live = guest.run(
        "./pleinair run --camera synthetic --style none --size 160x120 --frames 5 --output out.y4m",
        seconds=60)
    assert live.output.startswith("showed 5 frames"), live.output
