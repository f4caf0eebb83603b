# With HyperQueue, whose server and workers run already:
#   bash SCRIPT submit ROUND      runs the parts of a round that are not finished, and merges them
# It stays until all is done. What it waits for does not need it: stopped, it is started again and waits on.

# Runs the parts that are missing as a task array, as often as some of them are stopped at the end of their time, and merges them.
submit() {
  local missing job
  mkdir -p "$place/log"
  while missing=$(missing 0 "$parts"); [ -n "$missing" ]; do
    if is_known; then
      job=$(cat "$place/job")
      echo "round $round of $name: job $job is under way already"
    else
      rm -f "$place"/log/stopped-*
      job=$(hq --output-mode=quiet submit "${options[@]}" --name="$name" --array="$missing" --cwd="$place" \
        --stdout="$place/log/part-%{TASK_ID}-%{JOB_ID}-%{INSTANCE_ID}.txt" --stderr=none \
        -- bash "$SWITCHBACK_SCRIPT" part "$round")
      echo "$job" > "$place/job"
      echo "round $round of $name: job $job runs parts $missing; what they say is in $place/log"
    fi
    hq job wait "$job" || true
    if ! is_known; then
      echo "the server does not answer, or has forgotten job $job; once it is there again: bash $SWITCHBACK_SCRIPT" >&2
      return 1
    fi
    rm "$place/job"
    compgen -G "$place/log/stopped-*" > /dev/null || break
  done
  merge
}

# Whether the server knows the job that was submitted last, be it finished or not.
is_known() {
  [ -e "$place/job" ] && hq --output-mode=json job info "$(cat "$place/job")" 2> /dev/null | grep -qF "$place"
}

# Runs one part. Signalled that its time is up, it goes on in another turn.
part() {
  local code=0
  exec 2>&1
  run_part "$HQ_TASK_ID" "$threads" "$seconds" || code=$?
  [ "$code" -ne 3 ] || touch "$place/log/stopped-$HQ_TASK_ID"
  return "$code"
}

case $task in
  submit) submit ;;
  part) part ;;
  merge) merge ;;
  missing) missing 0 "$parts" && echo ;;
  *) echo "no such task: $task" >&2; exit 2 ;;
esac
