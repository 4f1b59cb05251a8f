t1 = 0.5 * a; T1 = 0.5 * a;
t2 rnd= t1 * e; T2 = T1 * e;
t3 rnd= v + t2; T3 = v + T2;
t4 rnd= t3 * e; T4 = T3 * e;
