"""How like people's a walk is: the knee's curve, stride by stride, against the height of the step.

Run it with: python examples/compare_with_people.py
"""

from humanwalk import load_scenario, simulate
from humanwalk.measures.human_likeness import compare


def main(heights: tuple[float, ...] = (0.12, 0.16, 0.20), duration: float = 4.0) -> dict[float, float]:
    """Walk with every height of the step [m]; return the right knee's mean correlation with people's by height."""
    found = {}
    for height in heights:
        scenario = load_scenario(
            "thesis", {"controller.thesis.gait.path.step_height": str(height), "duration": str(duration)}
        )
        comparison = compare(simulate(scenario).signals, scenario)
        knee = comparison.curves["knee"]["Right"]
        found[height] = float(knee.correlation.mean())
        print(
            f"{height:.2f} m: correlation {found[height]:.2f}, rms {knee.rms.mean():.1f} deg, {knee.rms.size} strides"
        )
    return found


if __name__ == "__main__":
    main()
