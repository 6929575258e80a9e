# The monitor: maps pages, refills the TLB, turns system calls into the service block's. MIPS I, in kseg0.
# Calls keep all registers but v0, a3, at, t0-t9, hi and lo, as Linux o32 says.
#include "models/parts/service_block/service_block_isa.h"

#define SERVICE 0xBF000000
#define index   $0
#define entrylo $2
#define context $4
#define badvaddr $8
#define entryhi $10
#define status  $12
#define cause   $13
#define epc     $14

        .set    noreorder
        .set    noat
        .section .vectors, "ax"
# 0x80000000: a page of kuseg is not in the TLB. Context points at its word in the page table; one that is not mapped
# yet is written invalid and comes back through the other vector.
utlb:   mfc0    $k0, context
        mfc0    $k1, epc
        lw      $k0, 0($k0)
        nop
        mtc0    $k0, entrylo
        nop
        tlbwr
        jr      $k1
        rfe

        .org    0x80
# 0x80000080: everything else.
general:
        mfc0    $k0, cause
        nop
        andi    $k0, $k0, 0x7C
        addiu   $k1, $k0, -(8 << 2)
        beq     $k1, $zero, call
        addiu   $k1, $k0, -(2 << 2)
        sltiu   $k1, $k1, 5             # TLBL, TLBS
        bne     $k1, $zero, page
        nop
        bne     $k0, $zero, fault
        nop
        j       fpu                     # interrupt: nothing but the R3010 pulls a line
        nop

        .globl  monitor_start
        .org    DENDRO_MONITOR_START
# From the loader, in kernel mode with an empty TLB.
monitor_start:
        lui     $t0, SERVICE >> 16
        lw      $t1, DENDRO_SERVICE_MAPPED($t0)
        lui     $t2, DENDRO_PAGE_TABLE >> 16
        lw      $t3, DENDRO_SERVICE_BREAK($t0)
        mtc0    $t2, context
        lui     $t2, %hi(program_break)
        sw      $t3, %lo(program_break)($t2)
        sw      $t3, %lo(first_break)($t2)
        beq     $t1, $zero, enter
        li      $t4, 0x20000000         # unmapped: kernel mode, R3010 usable
        # Pages of the program, one to one: from its first page to the break.
        li      $t5, 0x00400000
        lui     $t6, DENDRO_PAGE_TABLE >> 16
1:      srl     $t7, $t5, 10
        addu    $t7, $t7, $t6
        ori     $t8, $t5, 0x700         # dirty, valid, global
        sw      $t8, 0($t7)
        addiu   $t5, $t5, 0x1000
        sltu    $at, $t5, $t3
        bne     $at, $zero, 1b
        nop
        li      $t4, 0x20000008         # the rfe below makes it user mode
enter:  # The R3010's interrupt is enabled while the program runs.
        ori     $t4, $t4, 0xFC04
        lw      $sp, DENDRO_SERVICE_STACK($t0)
        lw      $k1, DENDRO_SERVICE_ENTRY($t0)
        mtc0    $t4, status
        nop
        nop
        ctc1    $zero, $31
        jr      $k1
        rfe

# k0, k1: the program's place to go on behind a syscall. One in a branch's slot is not a call that a compiler makes.
call:
        mfc0    $k0, cause
        nop
        bltz    $k0, fault
        slti    $at, $v0, 0x7000
        beq     $at, $zero, forward
        lui     $t0, SERVICE >> 16
        li      $t1, 4045
        beq     $v0, $t1, brk
        li      $t1, 4003
        beq     $v0, $t1, transfer
        li      $t1, 4004
        beq     $v0, $t1, transfer
        li      $t1, 4005
        beq     $v0, $t1, open
        nop
forward:                                # arguments without addresses
        lui     $t0, SERVICE >> 16
        sw      $a0, DENDRO_SERVICE_ARGUMENT($t0)
        sw      $a1, DENDRO_SERVICE_ARGUMENT+4($t0)
        sw      $a2, DENDRO_SERVICE_ARGUMENT+8($t0)
        sw      $v0, DENDRO_SERVICE_CALL($t0)
        lw      $v0, DENDRO_SERVICE_RESULT($t0)
        lw      $a3, DENDRO_SERVICE_FAILED($t0)
done:
        mfc0    $k1, epc
        nop
        addiu   $k1, $k1, 4
        jr      $k1
        rfe

# Physical address of t1 in t2, mapping its page if the program may have it; without one t2 is -1. A program in user mode
# has none in kseg0 to kseg2. Uses at, t3-t5, ra as k0.
physical:
        bltz    $t1, 2f
        srl     $t2, $t1, 12
        sll     $t2, $t2, 2
        lui     $t3, DENDRO_PAGE_TABLE >> 16
        addu    $t3, $t3, $t2
        lw      $t2, 0($t3)
        nop
        bne     $t2, $zero, 1f
        srl     $t2, $t2, 12
        # Not mapped yet: heap pages lie one to one, stack pages at the end of memory.
        lui     $t4, 0x8000
        subu    $t4, $t4, $t1           # distance from the top of kuseg
        lui     $t2, DENDRO_STACK_BYTES >> 16
        sltu    $at, $t2, $t4
        bne     $at, $zero, 3f
        srl     $t2, $t1, 12
        lui     $t4, SERVICE >> 16
        lw      $t4, DENDRO_SERVICE_MEMORY($t4)
        lui     $t5, 0x8000
        subu    $t5, $t1, $t5
        addu    $t5, $t5, $t4
        b       4f
        srl     $t2, $t5, 12
3:      lw      $t4, first_break
        lw      $t5, program_break
        sltu    $at, $t1, $t4
        bne     $at, $zero, 5f
        sltu    $at, $t1, $t5
        beq     $at, $zero, 5f
        nop
4:      sll     $t5, $t2, 12
        ori     $t4, $t5, 0x700
        sw      $t4, 0($t3)
1:      andi    $t1, $t1, 0xFFF
        sll     $t2, $t2, 12
        jr      $k0
        or      $t2, $t2, $t1
2:      mfc0    $t3, status
        sll     $t2, $t1, 3             # kseg0, kseg1
        andi    $t3, $t3, 8             # the program's mode
        bne     $t3, $zero, 5f
        srl     $t2, $t2, 3
        jr      $k0
        nop
5:      jr      $k0
        li      $t2, -1

# TLBL, TLBS: t-registers belong to the program.
page:
        mfc0    $k1, badvaddr
        lui     $k0, %hi(saved)
        sw      $at, %lo(saved)+0($k0)
        sw      $t1, %lo(saved)+4($k0)
        sw      $t2, %lo(saved)+8($k0)
        sw      $t3, %lo(saved)+12($k0)
        sw      $t4, %lo(saved)+16($k0)
        sw      $t5, %lo(saved)+20($k0)
        bltz    $k1, nopage             # kseg2, or unmapped code that has lost its way
        move    $t1, $k1
        la      $k0, 1f
        j       physical
        nop
1:      li      $at, -1
        beq     $t2, $at, nopage
        srl     $t2, $t2, 12
        sll     $t2, $t2, 12
        ori     $t2, $t2, 0x700
        mtc0    $t2, entrylo
        tlbp
        nop
        mfc0    $t1, index
        nop
        bltz    $t1, 2f
        nop
        b       3f
        tlbwi
2:      tlbwr
3:      lui     $k0, %hi(saved)
        lw      $at, %lo(saved)+0($k0)
        lw      $t1, %lo(saved)+4($k0)
        lw      $t2, %lo(saved)+8($k0)
        lw      $t3, %lo(saved)+12($k0)
        lw      $t4, %lo(saved)+16($k0)
        lw      $t5, %lo(saved)+20($k0)
        mfc0    $k1, epc
        nop
        jr      $k1
        rfe
nopage:
        lui     $k0, %hi(saved)
        lw      $at, %lo(saved)+0($k0)
        lw      $t1, %lo(saved)+4($k0)
        lw      $t2, %lo(saved)+8($k0)
        lw      $t3, %lo(saved)+12($k0)
        lw      $t4, %lo(saved)+16($k0)
        lw      $t5, %lo(saved)+20($k0)
fault:
        lui     $k0, SERVICE >> 16
        mfc0    $k1, cause
        nop
        sw      $k1, DENDRO_SERVICE_ARGUMENT($k0)
        mfc0    $k1, epc
        nop
        sw      $k1, DENDRO_SERVICE_ARGUMENT+4($k0)
        mfc0    $k1, badvaddr
        nop
        sw      $k1, DENDRO_SERVICE_ARGUMENT+8($k0)
        cfc1    $k1, $31
        nop
        sw      $k1, DENDRO_SERVICE_ARGUMENT+12($k0)
        li      $k1, DENDRO_CALL_FAULT
        sw      $k1, DENDRO_SERVICE_CALL($k0)
        b       .
        nop

# brk(a0): the new break, or the old one where there is no room.
brk:
        lui     $t6, %hi(program_break)
        lw      $t1, %lo(program_break)($t6)
        lw      $t2, %lo(first_break)($t6)
        lw      $t7, %lo(given_back)($t6)
        move    $a3, $zero
        sltu    $at, $a0, $t2
        bne     $at, $zero, done
        move    $v0, $t1
        lw      $t3, DENDRO_SERVICE_MEMORY($t0)
        lw      $t4, DENDRO_SERVICE_MAPPED($t0)
        lui     $t5, DENDRO_STACK_BYTES >> 16
        subu    $t3, $t3, $t5
        bne     $t4, $zero, 1f
        lui     $t5, 0x8000
        addu    $t3, $t3, $t5
1:      sltu    $at, $t3, $a0
        bne     $at, $zero, done
        sltu    $at, $t1, $t7
        sltu    $t3, $a0, $t1
        or      $at, $at, $t3
        bne     $at, $zero, used
        sw      $a0, %lo(program_break)($t6)
        b       done
        move    $v0, $a0
# The break falls, or it has fallen before: what is taken again, t1 to the lower of a0 and t7, is cleared. Heap pages lie one
# to one, so kseg0 reaches them.
used:
        beq     $t3, $zero, 1f
        move    $v0, $a0
        sltu    $at, $t7, $t1
        beq     $at, $zero, done
        nop
        j       done
        sw      $t1, %lo(given_back)($t6)
1:      sltu    $at, $a0, $t7
        beq     $at, $zero, 2f
        nop
        move    $t7, $a0
2:      beq     $t1, $t7, done
        lui     $t5, 0x8000
        or      $t1, $t1, $t5
        or      $t7, $t7, $t5
        swl     $zero, 0($t1)           # to the word's end; behind the new break nobody's bytes are left
        ori     $t1, $t1, 3
        addiu   $t1, $t1, 1
3:      sltu    $at, $t1, $t7
        beq     $at, $zero, done
        nop
        sw      $zero, 0($t1)
        b       3b
        addiu   $t1, $t1, 4

# read and write: page by page, since pages need not be neighbours in memory. t6: done so far, t7: left, t8: address. Bytes
# from kuseg into kseg0 are refused before the first is moved; those that begin behind kuseg are judged by `physical`.
transfer:
        addu    $t1, $a1, $a2
        addiu   $t1, $t1, -1
        or      $t1, $t1, $a2           # more than all of kuseg would come round again
        move    $t6, $zero
        move    $t7, $a2
        bltz    $t1, 7f
        move    $t8, $a1
1:      move    $t1, $t8
        la      $k0, 2f
        j       physical
        nop
2:      li      $at, -1
        beq     $t2, $at, bad_address
        andi    $t3, $t8, 0xFFF
        li      $t4, 0x1000
        subu    $t4, $t4, $t3           # to the page's end
        sltu    $at, $t7, $t4
        beq     $at, $zero, 3f
        nop
        move    $t4, $t7
3:      lui     $t0, SERVICE >> 16
        sw      $a0, DENDRO_SERVICE_ARGUMENT($t0)
        sw      $t2, DENDRO_SERVICE_ARGUMENT+4($t0)
        sw      $t4, DENDRO_SERVICE_ARGUMENT+8($t0)
        sw      $v0, DENDRO_SERVICE_CALL($t0)
        lw      $t1, DENDRO_SERVICE_RESULT($t0)
        lw      $a3, DENDRO_SERVICE_FAILED($t0)
        nop
        bne     $a3, $zero, 5f
        nop
        addu    $t6, $t6, $t1
        subu    $t7, $t7, $t1
        addu    $t8, $t8, $t1
        bne     $t1, $t4, 4f            # short: end of file, a terminal's line
        nop
        bne     $t7, $zero, 1b
        nop
4:      j       done
        move    $v0, $t6
5:      beq     $t6, $zero, 6f          # an error behind the first page comes back at the next call
        nop
        move    $a3, $zero
        j       done
        move    $v0, $t6
6:      j       done
        move    $v0, $t1
7:      bltz    $t8, 1b
        nop
bad_address:
        bne     $t6, $zero, 4b
        move    $a3, $zero
        li      $a3, 1
        j       done
        li      $v0, 14                 # EFAULT

# open(a0 path): the path's bytes go to a buffer of the monitor's first.
open:
        la      $t6, path
        move    $t8, $a0
        li      $t7, 1024
1:      move    $t1, $t8
        la      $k0, 2f
        j       physical
        nop
2:      li      $at, -1
        beq     $t2, $at, 3f
        lui     $t1, 0x8000
        or      $t2, $t2, $t1
        lbu     $t1, 0($t2)
        addiu   $t8, $t8, 1
        sb      $t1, 0($t6)
        beq     $t1, $zero, 4f
        addiu   $t6, $t6, 1
        addiu   $t7, $t7, -1
        bne     $t7, $zero, 1b
        nop
        li      $a3, 1
        j       done
        li      $v0, 78                 # ENAMETOOLONG
3:      li      $a3, 1
        j       done
        li      $v0, 14
4:      la      $t6, path
        sll     $t6, $t6, 3
        srl     $t6, $t6, 3
        lui     $t0, SERVICE >> 16
        sw      $t6, DENDRO_SERVICE_ARGUMENT($t0)
        sw      $a1, DENDRO_SERVICE_ARGUMENT+4($t0)
        sw      $a2, DENDRO_SERVICE_ARGUMENT+8($t0)
        sw      $v0, DENDRO_SERVICE_CALL($t0)
        lw      $v0, DENDRO_SERVICE_RESULT($t0)
        lw      $a3, DENDRO_SERVICE_FAILED($t0)
        j       done
        nop

# The R3010 interrupts. An operation that it gave up on is finished in finish.c; what the program itself asked to trap is a
# fault. The frame is struct frame there. EPC and Cause are kept: reading the program's word may miss the TLB.
fpu:
        lui     $k0, %hi(frame)
        addiu   $k0, $k0, %lo(frame)
        sw      $zero, 0($k0)
        sw      $at, 4($k0)
        sw      $v0, 8($k0)
        sw      $v1, 12($k0)
        sw      $a0, 16($k0)
        sw      $a1, 20($k0)
        sw      $a2, 24($k0)
        sw      $a3, 28($k0)
        sw      $t0, 32($k0)
        sw      $t1, 36($k0)
        sw      $t2, 40($k0)
        sw      $t3, 44($k0)
        sw      $t4, 48($k0)
        sw      $t5, 52($k0)
        sw      $t6, 56($k0)
        sw      $t7, 60($k0)
        sw      $s0, 64($k0)
        sw      $s1, 68($k0)
        sw      $s2, 72($k0)
        sw      $s3, 76($k0)
        sw      $s4, 80($k0)
        sw      $s5, 84($k0)
        sw      $s6, 88($k0)
        sw      $s7, 92($k0)
        sw      $t8, 96($k0)
        sw      $t9, 100($k0)
        sw      $gp, 112($k0)
        sw      $sp, 116($k0)
        sw      $fp, 120($k0)
        sw      $ra, 124($k0)
        swc1    $f0, 128($k0)
        swc1    $f1, 132($k0)
        swc1    $f2, 136($k0)
        swc1    $f3, 140($k0)
        swc1    $f4, 144($k0)
        swc1    $f5, 148($k0)
        swc1    $f6, 152($k0)
        swc1    $f7, 156($k0)
        swc1    $f8, 160($k0)
        swc1    $f9, 164($k0)
        swc1    $f10, 168($k0)
        swc1    $f11, 172($k0)
        swc1    $f12, 176($k0)
        swc1    $f13, 180($k0)
        swc1    $f14, 184($k0)
        swc1    $f15, 188($k0)
        swc1    $f16, 192($k0)
        swc1    $f17, 196($k0)
        swc1    $f18, 200($k0)
        swc1    $f19, 204($k0)
        swc1    $f20, 208($k0)
        swc1    $f21, 212($k0)
        swc1    $f22, 216($k0)
        swc1    $f23, 220($k0)
        swc1    $f24, 224($k0)
        swc1    $f25, 228($k0)
        swc1    $f26, 232($k0)
        swc1    $f27, 236($k0)
        swc1    $f28, 240($k0)
        swc1    $f29, 244($k0)
        swc1    $f30, 248($k0)
        swc1    $f31, 252($k0)
        cfc1    $t0, $31
        mfhi    $s0
        mflo    $s1
        sw      $t0, 256($k0)
        mfc0    $t0, epc
        mfc0    $t1, cause
        sw      $t0, 260($k0)
        sw      $t1, 264($k0)
        ctc1    $zero, $31              # lets go of the line
        lui     $sp, %hi(stack_end)
        addiu   $sp, $sp, %lo(stack_end)
        move    $s2, $k0
        jal     finish_operation
        move    $a0, $k0
        move    $k0, $s2
        beq     $v0, $zero, unfinished
        lw      $t0, 256($k0)
        mthi    $s0
        mtlo    $s1
        ctc1    $t0, $31
        lwc1    $f0, 128($k0)
        lwc1    $f1, 132($k0)
        lwc1    $f2, 136($k0)
        lwc1    $f3, 140($k0)
        lwc1    $f4, 144($k0)
        lwc1    $f5, 148($k0)
        lwc1    $f6, 152($k0)
        lwc1    $f7, 156($k0)
        lwc1    $f8, 160($k0)
        lwc1    $f9, 164($k0)
        lwc1    $f10, 168($k0)
        lwc1    $f11, 172($k0)
        lwc1    $f12, 176($k0)
        lwc1    $f13, 180($k0)
        lwc1    $f14, 184($k0)
        lwc1    $f15, 188($k0)
        lwc1    $f16, 192($k0)
        lwc1    $f17, 196($k0)
        lwc1    $f18, 200($k0)
        lwc1    $f19, 204($k0)
        lwc1    $f20, 208($k0)
        lwc1    $f21, 212($k0)
        lwc1    $f22, 216($k0)
        lwc1    $f23, 220($k0)
        lwc1    $f24, 224($k0)
        lwc1    $f25, 228($k0)
        lwc1    $f26, 232($k0)
        lwc1    $f27, 236($k0)
        lwc1    $f28, 240($k0)
        lwc1    $f29, 244($k0)
        lwc1    $f30, 248($k0)
        lwc1    $f31, 252($k0)
        lw      $at, 4($k0)
        lw      $v0, 8($k0)
        lw      $v1, 12($k0)
        lw      $a0, 16($k0)
        lw      $a1, 20($k0)
        lw      $a2, 24($k0)
        lw      $a3, 28($k0)
        lw      $t0, 32($k0)
        lw      $t1, 36($k0)
        lw      $t2, 40($k0)
        lw      $t3, 44($k0)
        lw      $t4, 48($k0)
        lw      $t5, 52($k0)
        lw      $t6, 56($k0)
        lw      $t7, 60($k0)
        lw      $s0, 64($k0)
        lw      $s1, 68($k0)
        lw      $s2, 72($k0)
        lw      $s3, 76($k0)
        lw      $s4, 80($k0)
        lw      $s5, 84($k0)
        lw      $s6, 88($k0)
        lw      $s7, 92($k0)
        lw      $t8, 96($k0)
        lw      $t9, 100($k0)
        lw      $gp, 112($k0)
        lw      $sp, 116($k0)
        lw      $fp, 120($k0)
        lw      $ra, 124($k0)
        lw      $k1, 260($k0)
        nop
        jr      $k1
        rfe
unfinished:
        lui     $k1, SERVICE >> 16
        lw      $t1, 264($k0)
        lw      $t2, 260($k0)
        sw      $t1, DENDRO_SERVICE_ARGUMENT($k1)
        sw      $t2, DENDRO_SERVICE_ARGUMENT+4($k1)
        sw      $t0, DENDRO_SERVICE_ARGUMENT+12($k1)
        li      $t0, DENDRO_CALL_FAULT
        sw      $t0, DENDRO_SERVICE_CALL($k1)
        b       .
        nop

        .bss
        .balign 4
program_break: .space 4
first_break:   .space 4
given_back:    .space 4                 # the highest break that a lower one followed, or 0
saved:  .space 24
path:   .space 1028
frame:  .space 268
        .balign 8
        .space 1024
stack_end:
        .space 32
