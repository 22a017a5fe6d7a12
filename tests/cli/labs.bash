# labs.bash - lessons in tests: solved by the solutions, answered by the shell's own arithmetic. After `load helper`.

labs='broadcast cannon deadlock dynamics matrix-multiply prefix-sum ring sample-sort stencil'

# answer FOLDER QUESTION VALUE: writes a prediction.
answer() { sed -i "s/^  $2:.*/  $2: $3/" "$1/answers.yaml"; }

# number FOLDER KEY [FILE]: what scenario.yaml, or another file, of an attempt with a kernel says.
number() { sed -n "s/.*\b$2: *{*\(overhead: \)*\([0-9]*\).*/\2/p" "$1/${3:-scenario.yaml}" | head -n 1; }

# solve_program FOLDER: the solution in the place of the gap.
solve_program() { sh "$MIMDSIM_SRCDIR/labs/solutions/solve.sh" "$1"; }

# solve FOLDER LAB: the solution, and predictions by closed forms that are written here once more.
solve() {
    local f=$1 P L o g G b n steps m row level N h B q=1 k=0
    solve_program "$f"
    P=$(number "$f" ranks) L=$(number "$f" end_latency) o=$(number "$f" send) g=$(number "$f" gap) G=$(number "$f" gap_per_byte)
    b=$(number "$f" bytes) n=$(number "$f" n) steps=$(number "$f" steps) m=$(number "$f" m) h=$(number "$f" hop_latency)
    while [ $((1 << k)) -lt "${P:-1}" ]; do k=$((k + 1)); done
    while [ $((q * q)) -lt "${P:-1}" ]; do q=$((q + 1)); done
    local one=$(((2 * o + L) * 1000000 + (${b:-8} - 1) * G * 1000))
    case $2 in
    ring)
        set -- messages "$P" bytes $((P * b)) one-message $one whole-round $((P * one)) \
            measured-G $(($(number "$f" gap_per_byte measure.yaml) * 1000)) \
            measured-o $(($(number "$f" send measure.yaml) * 1000000)) \
            measured-L $(($(number "$f" end_latency measure.yaml) * 1000000)) \
            measured-g $(($(number "$f" gap measure.yaml) * 1000000)) ;;
    broadcast)
        set -- messages $((P - 1)) root-messages $k tree-time $((k * one)) \
            star-time $(((P - 2) * (g * 1000000 + (b - 1) * G * 1000) + one))
        local B S s time most=0 best=0
        B=$(number "$f" bytes measure.yaml) S=$(sed -n 's/.*chain of ranks in \([0-9]*\) segments.*/\1/p' "$f/answers.yaml")
        for s in 1 2 4 8 16 32 64 128 256; do
            local byte=$(((B / s - 1) * G * 1000)) apart=$((2 * o * 1000000))
            [ $apart -ge $((g * 1000000 + byte)) ] || apart=$((g * 1000000 + byte))
            time=$(((P - 1) * ((2 * o + L) * 1000000 + byte) + (s - 1) * apart))
            [ $most -ne 0 ] && [ $time -ge $most ] || { most=$time best=$s; }
            [ $s -ne "$S" ] || set -- "$@" pipeline-time $time
        done
        set -- "$@" best-segments $best ;;
    prefix-sum) set -- rounds $k messages $((P * k - (P - 1))) time $((k * one)) ;;
    stencil)
        set -- messages $((2 * (P - 1) * steps)) bytes $((2 * (P - 1) * steps * n * 8)) \
            send-overhead $((2 * (P - 1) * steps * o * 1000000)) ;;
    deadlock) set -- waiting "$P" messages "$P" bytes $((P * 8)) time $((2 * ((2 * o + 3 * L) * 1000000 + 7 * G * 1000))) ;;
    matrix-multiply)
        m=$(number "$f" strip)
        b=$((8 * m * m * P)) # a strip of m rows of m P numbers
        one=$(((2 * o + L) * 1000000 + (b - 1) * G * 1000))
        local flops=$((2 * m * P * m * P * m * P / P))
        set -- rows-messages $((P * (P - 1))) blocks-messages $((2 * P * (q - 1))) rows-bytes $((P * (P - 1) * b)) \
            blocks-bytes $((2 * P * (q - 1) * b)) rows-time $(((P - 1) * one + flops * 10000)) \
            blocks-time $((2 * (q - 1) * one + flops * 10000)) ;;
    cannon)
        B=$(number "$f" 'link: {bandwidth')
        b=$((8 * m * m))
        local bytes=$((b * 1000000 / B)) byte=$((1000000 / B)) # ps
        # a message through one, two, three routers
        local t1=$(((2 * o + L + h) * 1000000 + bytes - byte)) t2 t3
        t2=$((t1 + h * 1000000)) t3=$((t1 + 2 * h * 1000000))
        set -- messages $((2 * P * (q - 1))) torus-crossings $((2 * P * (q - 1))) tree-crossings $((2 * P * (q - 1))) \
            torus-busiest $((q - 1)) tree-busiest $((q * (q - 1))) torus-time $((2 * (q - 1) * t2)) \
            tree-time $(((q - 1) * (t1 + t3 + (q - 1) * bytes))) ;;
    sample-sort)
        set -- equal-messages $((P * (P - 1))) samples-messages $((P * (P - 1) + 2 * (P - 1))) equal-largest $((m * P / q)) \
            samples-largest "$m" samples-bytes $((8 * ((P - 1) * P + (P - 1) * (P - 1) + P * (m - m / P)))) ;;
    dynamics)
        N=$(sed -n 's/.*n = \([0-9]*\) bodies.*/\1/p' "$f/answers.yaml") row=$(number "$f" row_flops) level=$(number "$f" level_flops)
        local cross=0 parallel
        one=$(((2 * o + L) * 1000000 + 31 * G * 1000))
        k=0
        for n in 2 4 8 16 32 64; do
            k=$((k + 1))
            parallel=$((k * (level * 10000 + one) + (k - 1) * (g * 1000000 + 31 * G * 1000)))
            [ $cross -gt 0 ] || [ $parallel -ge $((n * row * 10000)) ] || cross=$n
            [ $n -ne "$N" ] || set -- rounds $k messages $((2 * (N * k - N + 1))) parallel-time $parallel
        done
        set -- "$@" serial-time $((N * row * 10000)) crossover $cross ;;
    esac
    while [ $# -gt 0 ]; do
        answer "$f" "$1" "$2"
        shift 2
    done
}

# solve_mpi FOLDER KERNEL: an MPI attempt of the student whose other attempt, KERNEL, is solved: the answers are the same.
solve_mpi() {
    local line
    line=$(grep '^program:' "$1/answers.yaml")
    solve_program "$1"
    sed "s/^program:.*/$line/" "$2/answers.yaml" >"$1/answers.yaml"
}
