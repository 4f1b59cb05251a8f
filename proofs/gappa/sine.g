# Sine and cosine of f64 for what is left of an angle, |r| <= pi/4, against the exact polynomials: how near these are to the
# functions is lemmas.py, polynomials. Coefficients are those of trig.rs, read from there.
@rnd = @format;
r = rnd(r_);
z rnd= r * r; Z = r * r;
w rnd= z * z; W = Z * Z;
se rnd= (@se2 * w + @se1) * w + @se0; SE = (@se2 * W + @se1) * W + @se0;
so rnd= (@so2 * w + @so1) * w + @so0; SO = (@so2 * W + @so1) * W + @so0;
ce rnd= (@ce2 * w + @ce1) * w + @ce0; CE = (@ce2 * W + @ce1) * W + @ce0;
co rnd= (@co2 * w + @co1) * w + @co0; CO = (@co2 * W + @co1) * W + @co0;
sp rnd= se + z * so; SP = SE + Z * SO;
cp rnd= ce + z * co; CP = CE + Z * CO;
q rnd= z * sp; Q = Z * SP;
g rnd= r * q; G = r * Q;
sin rnd= r + g; SIN = r + G;
k = 0.5 * z; K = 0.5 * Z;
b rnd= 1 - k; B = 1 - K;
m rnd= z * cp; M = Z * CP;
h rnd= z * m; H = Z * M;
cos rnd= b + h; COS = B + H;
{ r in [@lo,@hi] -> |sin - SIN| <= @bounds /\ |cos - COS| <= @boundc }
$ r in 16;
