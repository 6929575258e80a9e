# Entry: the stack holds argc, argv..., as Linux leaves it. Calls main(argc, argv) and exits with its result.
        .set    noreorder
        .set    noat
        .text
        .globl  __start
        .ent    __start
__start:
        lw      $a0, 0($sp)
        addiu   $a1, $sp, 4
        move    $fp, $zero
        move    $ra, $zero
        li      $at, -8
        and     $sp, $sp, $at
        jal     main
        addiu   $sp, $sp, -24
        move    $a0, $v0
        li      $v0, 4001
        syscall
        b       .
        nop
        .end    __start

# long dendro_call(number, a0, a1, a2): the monitor's a3 says whether v0 is an error.
        .globl  dendro_call
        .ent    dendro_call
dendro_call:
        move    $v0, $a0
        move    $a0, $a1
        move    $a1, $a2
        move    $a2, $a3
        syscall
        beq     $a3, $zero, 1f
        nop
        subu    $v0, $zero, $v0
1:      jr      $ra
        nop
        .end    dendro_call
