# P1: the offset of a point from an arc. Inputs x, y are the local coordinates as computed; the exact twin has the same ones.
# Claimed: |n' - n| <= u (2.01 Y + 1.01 X + 6.03 N) for |y| <= Y, |x| <= X, |n| <= N. What is bounded are the summands of the
# quotient, TA = y (2 radius - y) / (radius + d) and TB = x^2 / (radius + d), by |y| and |x| (lemmas.py: offset-y, offset-x), so
# that the radius may be anything.
@rnd = @format;
x = rnd(x_); y = rnd(y_); radius = rnd(radius_);
@recorded offset
TA = T17 / T20; TB = T18 / T20;
{ |x| in [1b-200,@X] /\ |y| in [1b-200,@Y] /\ radius in [1b-100,1b60] /\ |T21| in [1b-300,@N] /\ |TA| <= @Y /\ |TB| <= @X
  /\ |T10| >= 1b-300 /\ |T16| >= 1b-300 /\ |t17-t18| >= 1b-600 /\ |t19| >= 1b-600
  -> |t21 - T21| <= @bound /\ |t14 -/ T14| <= @u(3.02) /\ |t20 -/ T20| <= @u(4.02) }
t21 - T21 -> (t21 - t19/t20) + (t19/t20 - T21);
t19/t20 -> (t19/T20) / (1 + ((t20 - T20)/T20)) { t20 <> 0, T20 <> 0 };
t21 - t19/t20 -> ((t21 - t19/t20)/(t19/t20)) * (t19/t20) { t19 <> 0, t20 <> 0 };
t19/t20 - T21 -> (t19/T20 - T21)/(1 + ((t20 - T20)/T20)) - T21*(((t20 - T20)/T20)/(1 + ((t20 - T20)/T20))) { t20 <> 0, T20 <> 0 };
t19/T20 -> T21 + (t19/T20 - T21);
t19/T20 - T21 -> ((t19 - (t17-t18))/(t17-t18)) * ((t17-t18)/T20) + ((t17-t18)/T20 - T21) { T20 <> 0, t17-t18 <> 0 };
(t17-t18)/T20 -> T21 + ((t17-t18)/T20 - T21);
(t17-t18)/T20 - T21 -> ((t17 - T17)/T17)*TA - ((t18 - T18)/T18)*TB { T17 <> 0, T18 <> 0, T20 <> 0 };
