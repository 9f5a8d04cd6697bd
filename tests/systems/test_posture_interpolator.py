"""Posture interpolator: smooth desired angles between two samples."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from pydrake.systems.framework import Context

from humanwalk.control.hermite import hermite
from humanwalk.systems.posture_interpolator import PostureInterpolator

N = 3
X0, X1 = np.arange(2.0 * N), np.arange(2.0 * N)[::-1] / 4


def context_at(interpolator: PostureInterpolator, t: float) -> Context:
    context = interpolator.CreateDefaultContext()
    interpolator.GetInputPort("previous_state").FixValue(context, X0)
    interpolator.GetInputPort("previous_time").FixValue(context, [0.10])
    interpolator.GetInputPort("next_state").FixValue(context, X1)
    interpolator.GetInputPort("next_time").FixValue(context, [0.12])
    context.SetTime(t)
    return context


def test_ports() -> None:
    interpolator = PostureInterpolator(N)
    sizes = {
        interpolator.get_input_port(i).get_name(): interpolator.get_input_port(i).size()
        for i in range(interpolator.num_input_ports())
    }
    assert sizes == {"previous_state": 6, "previous_time": 1, "next_state": 6, "next_time": 1}
    port = interpolator.GetOutputPort("desired_state")
    assert (port.get_name(), port.size()) == ("desired_state", 6)


@given(t=st.floats(0.0, 0.2))
def test_desired_state_is_the_cubic_through_the_samples(t: float) -> None:
    interpolator = PostureInterpolator(N)
    context = context_at(interpolator, t)
    expected = hermite(t, 0.10, X0, 0.12, X1)
    np.testing.assert_allclose(interpolator.GetOutputPort("desired_state").Eval(context), expected, atol=1e-12)


def test_it_passes_through_both_samples() -> None:
    interpolator = PostureInterpolator(N)
    context = context_at(interpolator, 0.10)
    port = interpolator.GetOutputPort("desired_state")
    np.testing.assert_allclose(port.Eval(context), X0, atol=1e-12)
    context.SetTime(0.12)
    np.testing.assert_allclose(port.Eval(context), X1, atol=1e-12)


def test_a_new_sample_changes_the_output() -> None:
    interpolator = PostureInterpolator(N)
    context = context_at(interpolator, 0.12)
    port = interpolator.GetOutputPort("desired_state")
    np.testing.assert_allclose(port.Eval(context), X1, atol=1e-12)
    interpolator.GetInputPort("next_state").FixValue(context, 2 * X1)
    np.testing.assert_allclose(port.Eval(context), 2 * X1, atol=1e-12)
