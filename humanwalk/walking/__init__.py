"""Walking on the model's own feet: inverted pendulum, step planner, footholds, swing, commands and pushes."""
