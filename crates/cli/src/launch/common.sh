# Everything below is the same for every study. Usage, besides what the engine adds further down:
#   bash SCRIPT                   runs the parts that are not finished yet, and merges them; again and again, if need be
#   bash SCRIPT missing ROUND     the parts of a round that are not finished, as --array takes them
#   bash SCRIPT merge ROUND       merges a round
set -euo pipefail

# An engine may run a copy of this script.
export SWITCHBACK_SCRIPT=${SWITCHBACK_SCRIPT:-$(realpath "$0")}
task=${1:-submit}
round=${2:-1}
place=$work/round-$round
before=$work/round-$((round - 1))/merged

# The parts that are not finished, of COUNT behind FIRST, counted from FIRST: 1-4,7,9-24.
missing() {
  local first=$1 count=$2 number
  for ((number = 1; number <= count && first + number <= parts; number++)); do
    [ -e "$place/part-$((first + number))/part.json" ] || echo "$number"
  done | awk '
    function show() { if (NR > 0) printf "%s%s", (signalled++ ? "," : ""), (first == last ? first : first "-" last) }
    NR > 1 && $1 == last + 1 { last = $1; next }
    NR > 1 { show() }
    { first = last = $1 }
    END { show() }'
}

# Runs a part on so many threads. Signalled that its time is up, it keeps what is finished and returns 3; it goes on when it is run again.
# With SECONDS, it is reported after them.
run_part() {
  local number=$1 threads=$2 seconds=${3:-} from=() with=() clock='' code=0 status
  [ "$round" -eq 1 ] || from=(--from "$before")
  # Where only this shell is killed, the part must not go on: it is run elsewhere.
  ! command -v setpriv > /dev/null || with=(setpriv --pdeathsig KILL --)
  echo "part $number of $parts on $(hostname) at $(date +%FT%T)"
  running='' signalled=''
  trap 'signalled=yes; [ -z "$running" ] || kill -TERM "$running" 2> /dev/null || true' TERM
  "${with[@]}" "$switchback" "$scenario" --shard "$number/$parts" "${from[@]}" --threads "$threads" --yes --quiet \
    --out "$place/part-$number" &
  running=$!
  # Signalled before it ran.
  [ -z "$signalled" ] || kill -TERM "$running" 2> /dev/null || true
  if [ -n "$seconds" ]; then
    (trap 'kill "$!"' TERM; sleep "$seconds" & wait "$!" && kill -TERM "$running") > /dev/null 2>&1 &
    clock=$!
  fi
  # A signal ends the wait, not the part: it is waited for once more, and may be known to have ended by then (127).
  while
    signalled='' status=0
    wait "$running" || status=$?
    [ "$status" -eq 127 ] || code=$status
    [ -n "$signalled" ]
  do :; done
  # A signal from here on must not cut off what follows: that the part goes on in another turn.
  trap '' TERM
  [ -z "$clock" ] || kill "$clock" 2> /dev/null || true
  return "$code"
}

# Merges the parts that are finished: into the report, or, where a precision is not reached yet, into the start of another round.
merge() {
  local done=() before_it=() code=0 number
  for ((number = 1; number <= parts; number++)); do
    [ ! -e "$place/part-$number/part.json" ] || done+=("$place/part-$number")
  done
  if [ ${#done[@]} -eq 0 ]; then
    echo "no part of round $round is finished; what they say is in $place/log" >&2
    return 2
  fi
  [ "$round" -eq 1 ] || before_it=("$before")
  "$switchback" merge "${before_it[@]}" "${done[@]}" --out "$out" --next "$place/merged" || code=$?
  case $code in
    0 | 1) ;;
    2) echo "what the parts say is in $place/log; to run those that are missing: bash $SWITCHBACK_SCRIPT" >&2 ;;
    3) bash "$SWITCHBACK_SCRIPT" submit "$((round + 1))" && code=0 ;;
  esac
  return "$code"
}

