# With Slurm:
#   bash SCRIPT submit ROUND      submits the parts of a round that are not finished, and the job that merges them
#   sbatch --array=3,7 SCRIPT part ROUND 0      runs parts 3 and 7 of a round again

# Submits the parts that are missing as job arrays, no larger than the site allows, and the merge behind them.
submit() {
  local most first array arrays=() behind=() merge busy
  busy=$(squeue --me --noheader --name="$name,$name-merge" --format="%F|%k" | place=$place awk -F "|" '$2 == ENVIRON["place"] { print $1 }' | sort -u)
  if [ -n "$busy" ]; then
    echo "jobs of this round are under way already:" $busy "- wait for them, or scancel them first" >&2
    return 2
  fi
  mkdir -p "$place/log"
  most=$(($(scontrol show config | sed -n 's/^MaxArraySize *= *//p') - 1))
  for ((first = 0; first < parts; first += most)); do
    array=$(missing "$first" "$most")
    [ -n "$array" ] || continue
    arrays+=("$(sbatch --parsable "${options[@]}" --job-name="$name" --comment="$place" --array="$array" --requeue \
      --open-mode=append --signal="B:TERM@$notice" --output="$place/log/part-%A_%a.txt" \
      "$SWITCHBACK_SCRIPT" part "$round" "$first")")
  done
  # Behind all of them, whether or not they succeed: merge itself reports what is missing.
  [ ${#arrays[@]} -eq 0 ] || behind=(--dependency="afterany:$(IFS=:; echo "${arrays[*]}")")
  merge=$(sbatch --parsable "${options[@]}" --job-name="$name-merge" --comment="$place" "${behind[@]}" --requeue \
    --open-mode=append --output="$place/log/merge.txt" "$SWITCHBACK_SCRIPT" merge "$round")
  echo "round $round of $name: jobs ${arrays[*]:-(none: all parts are finished)} run the parts, job $merge merges them;" \
    "what they say is in $place/log"
}

# Runs one part. Signalled that its time is up, it is put back into the queue, where it goes on.
part() {
  local number=$(($1 + SLURM_ARRAY_TASK_ID)) code=0
  run_part "$number" "${SLURM_CPUS_PER_TASK:-1}" || code=$?
  if [ "$code" -eq 3 ]; then
    echo "part $number is stopped, and goes on later"
    scontrol requeue "$SLURM_JOB_ID"
    # Slurm ends this job, by SIGTERM.
    trap - TERM
    sleep 60
  fi
  return "$code"
}

case $task in
  submit) submit ;;
  part) part "${3:-0}" ;;
  merge) merge ;;
  missing) missing 0 "$parts" && echo ;;
  *) echo "no such task: $task" >&2; exit 2 ;;
esac
