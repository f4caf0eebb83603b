# Everything below is the same for every study. Usage: bash SCRIPT, or
#   bash SCRIPT submit ROUND      submits the parts of a round, and the job that merges them
#   sbatch --array=3,7 SCRIPT part ROUND 0      runs parts 3 and 7 of a round again
#   bash SCRIPT merge ROUND       merges a round
set -euo pipefail

# The scheduler runs a copy of this script.
export SWITCHBACK_SCRIPT=${SWITCHBACK_SCRIPT:-$(realpath "$0")}
task=${1:-submit}
round=${2:-1}
place=$work/round-$round
before=$work/round-$((round - 1))/merged

# Submits the parts as job arrays, no larger than the site allows, and the merge behind them.
submit() {
  mkdir -p "$place/log"
  local most first count arrays=()
  most=$(($(scontrol show config | sed -n 's/^MaxArraySize *= *//p') - 1))
  for ((first = 0; first < parts; first += most)); do
    count=$((parts - first < most ? parts - first : most))
    arrays+=("$(sbatch --parsable "${options[@]}" --job-name="$name" --array="1-$count" --requeue --open-mode=append \
      --signal=B:TERM@60 --output="$place/log/part-%A_%a.txt" "$SWITCHBACK_SCRIPT" part "$round" "$first")")
  done
  # Behind all of them, whether or not they succeed: merge itself tells what is missing.
  local merge
  merge=$(sbatch --parsable "${options[@]}" --job-name="$name-merge" --dependency="afterany:$(IFS=:; echo "${arrays[*]}")" \
    --requeue --open-mode=append --output="$place/log/merge.txt" "$SWITCHBACK_SCRIPT" merge "$round")
  echo "round $round: jobs ${arrays[*]} run $parts parts, job $merge merges them; what they say is in $place/log"
}

# Runs one part. Told that its time is up, it keeps what is finished and is put back into the queue, where it goes on.
part() {
  local number=$(($1 + SLURM_ARRAY_TASK_ID)) from=() child code
  [ "$round" -eq 1 ] || from=(--from "$before")
  "$switchback" "$scenario" --shard "$number/$parts" "${from[@]}" --threads "${SLURM_CPUS_PER_TASK:-1}" --quiet \
    --out "$place/part-$number" &
  child=$!
  trap 'kill -TERM "$child" 2> /dev/null || true' TERM
  # A signal ends the wait, not the part.
  while code=0; wait "$child" || code=$?; kill -0 "$child" 2> /dev/null; do :; done
  if [ "$code" -eq 3 ]; then
    echo "part $number is stopped, and goes on later"
    scontrol requeue "$SLURM_JOB_ID"
    sleep 60
  fi
  return "$code"
}

# Merges the parts that are finished: into the report, or, where a precision is not reached yet, into the start of another round.
merge() {
  local done=() before_it=() code=0
  for folder in "$place"/part-*; do
    [ ! -e "$folder/part.json" ] || done+=("$folder")
  done
  if [ ${#done[@]} -eq 0 ]; then
    echo "no part of round $round is finished; what they say is in $place/log" >&2
    return 2
  fi
  [ "$round" -eq 1 ] || before_it=("$before")
  "$switchback" merge "${before_it[@]}" "${done[@]}" --quiet --out "$place/merged" || code=$?
  case $code in
    0 | 1) "$switchback" merge "${before_it[@]}" "${done[@]}" --out "$out" || code=$? ;;
    3) bash "$SWITCHBACK_SCRIPT" submit "$((round + 1))" && code=0 ;;
  esac
  return "$code"
}

case $task in
  submit) submit ;;
  part) part "${3:-0}" ;;
  merge) merge ;;
  *) echo "no such task: $task" >&2; exit 2 ;;
esac
