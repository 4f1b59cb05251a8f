// TCG plugin for QEMU 7.2 and later (plugin API 1): exact instruction counts by symbol and by address, the lowest store
// to the stack, and an estimate of Cortex-M4 cycles.
//
//   cc -shared -fPIC -O2 -o mcount.so mcount.c
//   qemu-system-arm ... -plugin ./mcount.so,lo=0x20000000,hi=0x20400000,hot=counts.txt -d plugin -D log
//
// lo and hi bound the RAM in which stores are watched; hot names a file that gets "address count" lines. QEMU's plugin
// header is in no package, hence the declarations here. The cycles follow the costs that ARM documents (DDI 0439, tables
// 3-1 and 7-1) and are not validated on hardware: they serve for ratios, never as a figure.
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t plugin_id;
typedef struct tb tb;
typedef struct insn insn;
typedef uint32_t mem_info;
typedef void (*tb_callback)(plugin_id, tb *);
typedef void (*exec_callback)(unsigned, void *);
typedef void (*mem_callback)(unsigned, mem_info, uint64_t, void *);
void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id, tb_callback);
void qemu_plugin_register_vcpu_insn_exec_cb(insn *, exec_callback, int flags, void *);
void qemu_plugin_register_vcpu_mem_cb(insn *, mem_callback, int flags, int rw, void *);
void qemu_plugin_register_atexit_cb(plugin_id, void (*)(plugin_id, void *), void *);
size_t qemu_plugin_tb_n_insns(const tb *);
insn *qemu_plugin_tb_get_insn(const tb *, size_t);
const void *qemu_plugin_insn_data(const insn *);
size_t qemu_plugin_insn_size(const insn *);
uint64_t qemu_plugin_insn_vaddr(const insn *);
const char *qemu_plugin_insn_symbol(const insn *);
bool qemu_plugin_mem_is_store(mem_info);
void qemu_plugin_outs(const char *);
int qemu_plugin_version = 1;

struct symbol {
  char *name;
  uint64_t count, cycles;
  struct symbol *next;
};
struct place { // one translated instruction
  uint64_t at, next, count;
  unsigned cycles;
  struct symbol *symbol;
  struct place *older;
};
static struct symbol *symbols;
static struct place *places, *last;
static uint64_t count, cycles, lo, hi, lowest = UINT64_MAX;
static char hot[400];

static struct symbol *symbol(const char *name) {
  if (!name)
    name = "?";
  for (struct symbol *s = symbols; s; s = s->next)
    if (!strcmp(s->name, name))
      return s;
  struct symbol *s = calloc(1, sizeof *s);
  s->name = strdup(name);
  s->next = symbols;
  return symbols = s;
}

#define BITS(x) ((unsigned)__builtin_popcount(x))
static unsigned cost(const uint8_t *d, size_t size) { // a taken branch costs two more, added where the jump is seen
  unsigned a = d[0] | d[1] << 8, b = size == 4 ? d[2] | d[3] << 8 : 0;
  if (size == 2) {
    if ((a & 0xfe00) == 0xb400 || (a & 0xfe00) == 0xbc00) return 1 + BITS(a & 0x1ff); // push, pop
    if ((a & 0xf000) == 0xc000) return 1 + BITS(a & 0xff);                            // ldm, stm
    if ((a & 0xf800) == 0x4800) return 2;                                             // ldr literal
    if ((a & 0xf000) == 0x5000) return (a & 0x0e00) >= 0x0600 ? 2 : 1;                // loads 2, stores 1
    if ((a & 0xe000) == 0x6000 || (a & 0xf000) == 0x8000 || (a & 0xf000) == 0x9000) return a & 0x0800 ? 2 : 1;
    return 1;
  }
  if ((a & 0xfe40) == 0xe800) return 1 + BITS(b);                                       // ldm.w, stm.w
  if ((a & 0xfe40) == 0xe840) return 3;                                                 // ldrd, strd, tbb
  if ((a & 0xfe00) == 0xf800) return a & 0x10 ? 2 : 1;                                  // ldr.w, str.w
  if ((a & 0xff80) == 0xfb00) return (a & 0x70) == 0 && (b & 0xf000) != 0xf000 ? 2 : 1; // mla 2, mul 1
  if ((a & 0xffd0) == 0xfb90 && (b & 0xf0) == 0xf0) return 7;                           // sdiv, udiv: 2 to 12
  if ((a & 0xee00) == 0xec00 && (b & 0x0e00) == 0x0a00) {
    if ((a & 0x0fe0) == 0x0c40) return 2;                 // vmov of two registers
    if ((a & 0x0120) == 0x0100) return 2 + (b >> 8 & 1);  // vldr, vstr
    return 1 + (b & 0xff);                                // vldm, vpush
  }
  if ((a & 0xef00) == 0xee00 && (b & 0x0e10) == 0x0a00) {
    unsigned op = a & 0xb0;
    if (op == 0x80) return 14;                                           // vdiv
    if (op == 0xb0 && (a & 0xf) == 1 && (b & 0xc0) == 0xc0) return 14;   // vsqrt
    if (op == 0x00 || op == 0x10 || op == 0x90 || op == 0xa0) return 3;  // vmla, vnmla, vfma
  }
  return 1;
}

static void executed(unsigned cpu, void *data) {
  (void)cpu;
  struct place *p = data;
  if (last && last->next != p->at) {
    cycles += 2;
    last->symbol->cycles += 2;
  }
  count++;
  p->count++;
  p->symbol->count++;
  cycles += p->cycles;
  p->symbol->cycles += p->cycles;
  last = p;
}

static void stored(unsigned cpu, mem_info info, uint64_t at, void *data) {
  (void)cpu, (void)data;
  if (qemu_plugin_mem_is_store(info) && at >= lo && at < hi && at < lowest)
    lowest = at;
}

static void translated(plugin_id id, tb *block) {
  (void)id;
  for (size_t i = 0, n = qemu_plugin_tb_n_insns(block); i < n; i++) {
    insn *in = qemu_plugin_tb_get_insn(block, i);
    struct place *p = calloc(1, sizeof *p);
    p->at = qemu_plugin_insn_vaddr(in);
    p->next = p->at + qemu_plugin_insn_size(in);
    p->cycles = cost(qemu_plugin_insn_data(in), qemu_plugin_insn_size(in));
    p->symbol = symbol(qemu_plugin_insn_symbol(in));
    p->older = places;
    places = p;
    qemu_plugin_register_vcpu_insn_exec_cb(in, executed, 0, p);
    if (hi)
      qemu_plugin_register_vcpu_mem_cb(in, stored, 0, 2, 0);
  }
}

static int by_count(const void *a, const void *b) {
  uint64_t x = (*(struct symbol *const *)a)->count, y = (*(struct symbol *const *)b)->count;
  return (x < y) - (x > y);
}

static void finished(plugin_id id, void *data) {
  (void)id, (void)data;
  char line[600];
  snprintf(line, sizeof line, "insns %llu m4_cycles~ %llu", (unsigned long long)count, (unsigned long long)cycles);
  qemu_plugin_outs(line);
  if (hi) {
    snprintf(line, sizeof line, " stack_used %lld", lowest == UINT64_MAX ? 0 : (long long)(hi - lowest));
    qemu_plugin_outs(line);
  }
  qemu_plugin_outs("\n");
  static struct symbol *sorted[4096];
  size_t n = 0;
  for (struct symbol *s = symbols; s && n < 4096; s = s->next)
    sorted[n++] = s;
  qsort(sorted, n, sizeof *sorted, by_count);
  for (size_t i = 0; i < n; i++) {
    snprintf(line, sizeof line, "%10llu insns %10llu cycles~ %s\n", (unsigned long long)sorted[i]->count,
             (unsigned long long)sorted[i]->cycles, sorted[i]->name);
    qemu_plugin_outs(line);
  }
  FILE *f = *hot ? fopen(hot, "w") : NULL;
  for (struct place *p = places; f && p; p = p->older)
    if (p->count)
      fprintf(f, "%llx %llu\n", (unsigned long long)p->at, (unsigned long long)p->count);
  if (f)
    fclose(f);
}

int qemu_plugin_install(plugin_id id, const void *info, int argc, char **argv) {
  (void)info;
  for (int i = 0; i < argc; i++) {
    if (!strncmp(argv[i], "lo=", 3))
      lo = strtoull(argv[i] + 3, NULL, 0);
    if (!strncmp(argv[i], "hi=", 3))
      hi = strtoull(argv[i] + 3, NULL, 0);
    if (!strncmp(argv[i], "hot=", 4))
      snprintf(hot, sizeof hot, "%s", argv[i] + 4);
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, finished, NULL);
  return 0;
}
