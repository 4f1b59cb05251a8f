/* Reset of a Cortex-M4F: FPU on, data in place, semihosting for printf and the exit status. */
#include <stdint.h>
extern uint32_t _estack, _sidata, _sdata, _edata, _sbss, _ebss;
extern void initialise_monitor_handles(void);
extern int main(void);
extern void exit(int) __attribute__((noreturn));

void Reset_Handler(void) {
  *(volatile uint32_t *)0xE000ED88 |= 0xFu << 20; /* CPACR: full access to CP10 and CP11 */
  __asm volatile("dsb\n isb");
  for (uint32_t *from = &_sidata, *to = &_sdata; to < &_edata;) *to++ = *from++;
  for (uint32_t *to = &_sbss; to < &_ebss;) *to++ = 0;
  initialise_monitor_handles();
  exit(main());
}

/* A fault ends QEMU as a lockup, which is a failure. */
static void Fault(void) { __asm volatile("udf #0"); }

typedef union {
  void (*handler)(void);
  const uint32_t *stack;
} Vector;
__attribute__((section(".isr"), used)) static const Vector vectors[16] = {
    {.stack = &_estack}, {Reset_Handler}, {Fault}, {Fault}, {Fault}, {Fault}, {Fault}};
