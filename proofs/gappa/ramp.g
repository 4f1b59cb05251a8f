# The way since the slow end of a phase, relative: for speed, acceleration and time as they are.
@rnd = @format;
a = rnd(a_); e = rnd(e_); v = rnd(v_);
@recorded ramp
{ a in [1b-200,1b60] /\ e in [1b-200,1b60] /\ v in [1b-200,1b60] -> |t4 -/ T4| <= @u(3.01) }
