"""Control as plain mathematics, without Systems: joint torques, inverse kinematics, balance."""
