# Local coordinates, each operation of which is one rounding: of the components of the difference (1), of the products and of
# their sum (2). The direction is taken as exact here; its error turns the frame.
@rnd = @format;
px = rnd(px_); py = rnd(py_); sx = rnd(sx_); sy = rnd(sy_); c = rnd(c_); s = rnd(s_);
C = c; S = s;
@recorded local
{ |T3| in [1b-300,1] /\ |T4| in [1b-300,@small] /\ |T7| in [1b-300,1] /\ |T8| in [1b-300,@small] /\ |T1| >= 1b-300 /\ |T2| >= 1b-300 /\ |c| >= 1b-300 /\ |s| >= 1b-300
  -> |t5 - T5| <= @u(3.01) /\ |t9 - T9| <= @u(3.01) }
t5 - T5 -> (t5 - (t3 + t4)) + ((t3 - T3)/T3) * T3 + ((t4 - T4)/T4) * T4 { T3 <> 0, T4 <> 0 };
t9 - T9 -> (t9 - (t7 + t8)) + ((t7 - T7)/T7) * T7 + ((t8 - T8)/T8) * T8 { T7 <> 0, T8 <> 0 };
