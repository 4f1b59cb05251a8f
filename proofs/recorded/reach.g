t31 = |n|; T31 = |n|;
# t31 is Some(Less) to r
t33 rnd= radius + d; T33 = radius + d;
# t33 is Some(Greater) to r
t35 rnd= r - t31; T35 = r - T31;
t36 rnd= r + t31; T36 = r + T31;
t37 rnd= t35 * t36; T37 = T35 * T36;
t38 rnd= sqrt(t37); T38 = sqrt(T37);
t39 rnd= t33 - r; T39 = T33 - r;
t40 rnd= t33 + r; T40 = T33 + r;
t41 rnd= t39 * t40; T41 = T39 * T40;
t42 rnd= sqrt(t41); T42 = sqrt(T41);
