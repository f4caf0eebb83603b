% Least squares on the over-parameterised regression, as `joint` does it, in GNU Octave: the protocol switchback/method/1 and the columns of regression.py.
1;

function x = stored(request, where)
  % Numbers of the block. It changes from request to request, and is opened anew.
  file = fopen(request.block, "rb");
  fseek(file, 8 * where.at, "bof");
  x = fread(file, where.count, "double", 0, "ieee-le");
  fclose(file);
end

function u = inputs(request, k, e, v)
  % Where the input is known to be 1, then V2 … Vm of the descendant, of the ascendant experiment.
  half = request.points - 1;
  u = zeros(numel(v), 1 + 2 * half);
  known = {e.satellite, e.levels(1)};
  u(:, 1) = v == known{k};
  for j = 1:half
    u(:, 1 + (k - 1) * half + j) = v == e.levels(j + 1);
  end
end

function [phi, y] = columns(request)
  % Columns -y(t-1) … -y(t-n), each input at each lag, and 1; and y(t).
  n = request.order;
  phi = []; y = [];
  for k = 1:2
    e = request.experiments(k);
    v = stored(request, e.v);
    of = stored(request, request.y(k));
    rows = e.lead + (1:request.samples);
    u = inputs(request, k, e, v);
    block = zeros(request.samples, n);
    for i = 1:n
      block(:, i) = -of(rows - i);
    end
    for i = 1:n
      block = [block, u(rows - i, :)];
    end
    phi = [phi; block, ones(request.samples, 1)];
    y = [y; of(rows)];
  end
end

function found = estimate(request)
  [phi, y] = columns(request);
  theta = phi \ y;
  n = request.order; half = request.points - 1;
  a = theta(1:n);
  mu = reshape(theta(n+1:end-1), 1 + 2 * half, n)';
  b = mu(:, 1);
  w = (b' * mu(:, 2:end)) / (b' * b);
  low = theta(end) / sum(b);
  found = [a', b', low, low + w(1:half), low + 1, low + w(half+1:end)];
end

function line = next_line()
  % The next line, or -1 at the end. fgetl waits for the first character behind it, which is not there before an answer.
  try
    line = input("", "s");
  catch
    line = -1;
  end
end

greeting = jsondecode(next_line());
if ! strcmp(greeting.schema, "switchback/method/1")
  error("the program speaks another protocol");
end
printf("{\"schema\":\"switchback/method/1\",\"version\":\"octave %s\"}\n", OCTAVE_VERSION);
fflush(stdout);
while ischar(line = next_line())
  request = jsondecode(line);
  try
    found = estimate(request);
    numbers = sprintf("%.17g,", found);
    printf("{\"id\":%d,\"estimate\":[%s]}\n", request.id, numbers(1:end-1));
  catch why
    printf("{\"id\":%d,\"failed\":%s}\n", request.id, jsonencode(why.message));
  end
  fflush(stdout);
end
