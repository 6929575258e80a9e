#pragma once

/// The service block: words at physical DENDRO_SERVICE_BASE, the one place where a program's calls leave the
/// machine. Only the monitor touches it. Included by the monitor's assembly source too, so nothing but
/// defines. ASSUMED DEV-118
#define DENDRO_SERVICE_BASE 0x1F000000
#define DENDRO_SERVICE_BYTES 0x40
#define DENDRO_SERVICE_CALL 0x00     /* write: the call's number; it is done when the store ends */
#define DENDRO_SERVICE_ARGUMENT 0x04 /* write: 4 words; addresses are physical */
#define DENDRO_SERVICE_RESULT 0x14   /* read: the result, or the error's number */
#define DENDRO_SERVICE_FAILED 0x18   /* read: 1 if the call failed */
#define DENDRO_SERVICE_ENTRY 0x1C    /* read: the program's first word */
#define DENDRO_SERVICE_STACK 0x20    /* read: its first stack pointer */
#define DENDRO_SERVICE_BREAK 0x24    /* read: the first address behind the program, rounded up to a page */
#define DENDRO_SERVICE_MEMORY 0x28   /* read: bytes of main memory */
#define DENDRO_SERVICE_MAPPED 0x2C   /* read: 1 if the program runs in user mode through the TLB */

/* Calls that mark phases: argument 0 is the program's label */
#define DENDRO_MARK_START 0x7000
#define DENDRO_MARK_STOP 0x7001
#define DENDRO_MARK_LABEL 0x7002

#define DENDRO_CALL_FAULT 0x6FFF /* the program raised an exception: Cause, EPC, BadVAddr, FCR31 */

#define DENDRO_PAGE_TABLE 0x80200000 /* 2 MB: a word in the form of EntryLo for every page of kuseg */
#define DENDRO_STACK_BYTES 0x00800000
#define DENDRO_MONITOR_START 0xC0 /* the monitor's first word, from its base 0x80000000 */
