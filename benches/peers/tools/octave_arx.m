% octave_arx (TASK, SOURCE, TARGET): fit a given record ("estimate") or time one replicate ("time").
function octave_arx (task, source, target)
  pkg load control
  job = prepare (jsondecode (fileread (source)));
  if (strcmp (task, "estimate"))
    result = regress (job, job.y);
  else
    randn ("twister", job.seed);
    replicate (job);  % Once untimed: the first call of a function parses its file.
    start = cputime ();
    replicate (job);
    result.seconds = cputime () - start;
  endif
  file = fopen (target, "w");
  fputs (file, jsonencode (result));
  fclose (file);
endfunction

% Pulse columns and noise-free forcing from one period of each.
function job = prepare (job)
  order = numel (job.a);
  one_period = job.visits' == (0:job.period-1)';
  job.pulses = double (one_period(phases (job, order),:));
  job.drive = job.forcing(phases (job, order + job.settling))(:);
endfunction

% The phases, from 1 on, of a record that begins so many samples before phase 0.
function index = phases (job, before)
  index = mod (-before:job.samples-1, job.period) + 1;
endfunction

function [b, f] = replicate (job)
  [y, y0] = simulate (job);
  [b, f] = border (regress (job, y - y0), y0);
endfunction

% Descendant and step experiment, as many samples each.
function [y, y0] = simulate (job)
  order = numel (job.a);
  y = respond (job, job.drive);
  step = respond (job, job.step_forcing);
  y0 = mean (step(order+1:end));
endfunction

function y = respond (job, drive)
  y = filter (1, [1; job.a], drive + job.noise * randn (numel (job.drive), 1))(job.settling+1:end);
endfunction

function fit = regress (job, y)
  order = numel (job.a);
  sys = arx (iddata (y, job.pulses, 1), "na", order, "nb", order * ones (1, numel (job.visits)));
  [num, den] = filtdata (sys);
  fit.a = den{1,1}(2:end);
  fit.heights = cell2mat (cellfun (@(b) b(2:order+1)(:), num(1,1:numel (job.visits)), "uniformoutput", false));
endfunction

% (3.24a-b), (3.25)
function [b, f] = border (fit, y0)
  b = -fit.heights(:,1);
  f = (b' * fit.heights) / (b' * b) + (1 + sum (fit.a)) / sum (b) * y0;
endfunction
