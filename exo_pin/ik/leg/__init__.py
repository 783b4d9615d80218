"""One leg with six joints: closed form, forward kinematics, and the check of every answer."""
