"""Runs an FMU with FMPy: run.py MODEL.fmu INPUT.csv, and prints what the test compares."""
import shutil
import sys

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu

fmu, inputs = sys.argv[1:]
# Against the schema of the standard, and what it says in words: names, units, start values, the structure of the model.
problems = validate_fmu(fmu)
assert not problems, problems
description = read_model_description(fmu)
variables = {one.name: one for one in description.modelVariables}
h = description.defaultExperiment.stepSize and float(description.defaultExperiment.stepSize)
v = np.loadtxt(inputs, skiprows=1)
folder = extract(fmu)


def instance(name="one"):
    slave = FMU2Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName=name,
    )
    slave.instantiate()
    return slave


def begin(slave, border=0):
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.setReal([variables["v"].valueReference], [v[0]])
    slave.setInteger([variables["border"].valueReference], [border])
    slave.exitInitializationMode()


def read(slave):
    return slave.getReal([variables["y"].valueReference])[0]


def run(slave, steps=1):
    delay = slave.getInteger([variables["output_delay"].valueReference])[0]
    y = [read(slave)]
    for t in range(0, len(v) - 1 + delay, steps):
        slave.setReal([variables["v"].valueReference], [v[min(t, len(v) - 1)]])
        slave.doStep(currentCommunicationPoint=t * h, communicationStepSize=steps * h)
        y.append(read(slave))
    return y[delay:]


def refused(act):
    try:
        act()
    except FMICallException:
        return True
    return False


first = v[np.flatnonzero(v != v[0])[0]] - v[0]
border = 1 if first > 0 else -1
slave, other = instance(), instance("another")
begin(slave, border)
y = run(slave)
for value in y:
    print(repr(value))

# A second instance does not disturb the first; a reset one does the same again, and by itself from the first move on.
begin(other, border)
assert run(other) == y
slave.terminate()
slave.reset()
begin(slave, 0)
moved = int(np.flatnonzero(v != v[0])[0])
assert run(slave)[moved + 1 :] == y[moved + 1 :], "without a border"

# A state is kept and comes back.
slave.reset()
begin(slave, border)
slave.setReal([variables["v"].valueReference], [v[3]])
slave.doStep(currentCommunicationPoint=0.0, communicationStepSize=h)
kept = slave.getFMUState()
before = read(slave)
slave.doStep(currentCommunicationPoint=h, communicationStepSize=h)
slave.setFMUState(kept)
assert read(slave) == before
slave.freeFMUState(kept)

# Steps of several samples hold the input; other steps, points and inputs are refused, and nothing is lost.
slave.doStep(currentCommunicationPoint=h, communicationStepSize=3 * h)
assert refused(lambda: slave.doStep(currentCommunicationPoint=4 * h, communicationStepSize=1.5 * h))
assert refused(lambda: slave.doStep(currentCommunicationPoint=9 * h, communicationStepSize=h))
assert refused(lambda: slave.setReal([variables["v"].valueReference], [float("nan")]))
assert refused(lambda: slave.setReal([variables["y"].valueReference], [1.0]))
assert refused(lambda: slave.setInteger([variables["border"].valueReference], [1]))
slave.doStep(currentCommunicationPoint=4 * h, communicationStepSize=h)

# It knows where it has left what it was identified on.
outside = variables["outside"].valueReference
assert not slave.getBoolean([outside])[0]
slave.setReal([variables["v"].valueReference], [1e3])
slave.doStep(currentCommunicationPoint=5 * h, communicationStepSize=h)
assert slave.getBoolean([outside])[0]
low, high = (variables["identified_on." + end] for end in ("lowest", "highest"))
assert slave.getReal([low.valueReference, high.valueReference]) == [float(low.start), float(high.start)]
slave.terminate()
slave.freeInstance()
other.freeInstance()
shutil.rmtree(folder)

# And as its users do.
result = simulate_fmu(fmu, stop_time=20 * h, step_size=h, output_interval=h, start_values={"v": float(v[0])})
assert len(result) == 21 and np.isfinite(result["y"]).all()
