#!/bin/bash
# Three Slurm nodes on one host, for tests: three slurmd on three ports of 127.0.0.1, one processor each, and a slurmctld. As root, into a new
# FOLDER: three-nodes.sh FOLDER. Configuration in FOLDER/slurm.conf; FOLDER/*.pid names what is to be stopped, by its number.
set -euo pipefail
folder=$1
host=$(hostname -s)
port=${PORT:-17817}
mkdir -p "$folder"/{state,munge,spool-n1,spool-n2,spool-n3}
chmod 755 "$folder" "$folder/munge"
cat > "$folder/slurm.conf" <<CONF
ClusterName=three
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
# A job that is put back into the queue waits until its credential has expired.
AuthInfo=socket=$folder/munge/munge.sock,cred_expire=8
CryptoType=crypto/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
SlurmdTimeout=${DOWN_AFTER:-30}
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,sched_interval=5,bf_interval=5
# Smaller than any site has it: 24 parts are three arrays.
MaxArraySize=11
NodeName=n[1-3] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 3))] CPUs=1 Boards=1 SocketsPerBoard=1 CoresPerSocket=1 ThreadsPerCore=1 RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=n[1-3] Default=YES MaxTime=INFINITE State=UP
CONF
(umask 077 && head -c 1024 /dev/urandom > "$folder/munge/munge.key")
munged --force --key-file="$folder/munge/munge.key" --socket="$folder/munge/munge.sock" --pid-file="$folder/munged.pid" \
  --log-file="$folder/munge/munged.log" --seed-file="$folder/munge/munge.seed"
slurmctld -f "$folder/slurm.conf"
for node in n1 n2 n3; do slurmd -f "$folder/slurm.conf" -N "$node"; done
