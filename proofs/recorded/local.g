t1 rnd= px - sx; T1 = px - sx;
t2 rnd= py - sy; T2 = py - sy;
t3 rnd= t1 * c; T3 = T1 * C;
t4 rnd= t2 * s; T4 = T2 * S;
t5 rnd= t3 + t4; T5 = T3 + T4;
t6 = - s; T6 = - S;
t7 rnd= t2 * c; T7 = T2 * C;
t8 rnd= t1 * t6; T8 = T1 * T6;
t9 rnd= t7 + t8; T9 = T7 + T8;
