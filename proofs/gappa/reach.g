# P1: the two roots of the half-width, for the offset n and the distance d as computed; FAR is of the diameter as computed.
@rnd = @format;
n = rnd(n_); d = rnd(d_); r = rnd(r_); radius = rnd(radius_);
@recorded reach
FAR = sqrt((t33 - r) * (t33 + r));
{ |n| in [0,1b60] /\ r in [1b-200,1b60] /\ d in [1b-200,1b60] /\ radius in [1b-200,1b60]
  /\ r - t31 >= 1b-300 /\ r + t31 >= 1b-300 /\ t33 - r >= 1b-300 /\ t33 + r >= 1b-300
  -> |t38 -/ T38| <= @u(2.52) /\ |t42 -/ FAR| <= @u(2.52) }
