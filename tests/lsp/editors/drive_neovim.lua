-- Does what tasks.json asks for as a user would, one file after the other, and writes answers.json.
-- The whole is a coroutine, so that the editor goes on while something is waited for.
local main

local function await(wanted, what)
  local deadline = vim.loop.now() + 60000
  while not wanted() do
    if vim.loop.now() > deadline then
      error("waited in vain for " .. what)
    end
    vim.defer_fn(function()
      coroutine.resume(main)
    end, 5)
    coroutine.yield()
    vim.loop.update_time()
  end
end

local function index(line, column) -- of a character -> of a byte
  return vim.str_byteindex(line, column)
end

local function marked(one)
  return table.concat(vim.api.nvim_buf_get_text(0, one.lnum, one.col, one.end_lnum, one.end_col, {}), "\n")
end

local function told()
  return vim.tbl_map(function(one)
    return { marked(one), (vim.split(one.message, "\n")[1]) }
  end, vim.diagnostic.get(0))
end

local function press(keys)
  vim.api.nvim_input(keys)
end

local function go(task, column)
  local line = vim.api.nvim_buf_get_lines(0, task.line - 1, task.line, false)[1] or ""
  vim.api.nvim_win_set_cursor(0, { task.line, index(line, column) })
end

local does = {}

function does.diagnose() end

function does.complete(task)
  go(task, math.max(task.column - 1, 0))
  press((task.column > 0 and "a" or "i") .. "<C-x><C-o>")
  await(function()
    return vim.fn.pumvisible() == 1
  end, "completions")
  local offered = vim.tbl_map(function(one)
    return one.word
  end, vim.fn.complete_info({ "items" }).items)
  for at, word in ipairs(offered) do
    if word == task.with then
      press(("<C-n>"):rep(at) .. "<C-y><Esc>")
      await(function()
        return vim.fn.mode() == "n"
      end, "the end of insertion")
      return
    end
  end
  press("<C-e><Esc>")
  error(task.with .. " is not among " .. vim.inspect(offered))
end

function does.hover(task)
  go(task, task.column)
  press("K")
  await(function()
    return vim.b.lsp_floating_preview ~= nil
  end, "the window that says it")
  local window = vim.b.lsp_floating_preview
  local lines = vim.api.nvim_buf_get_lines(vim.api.nvim_win_get_buf(window), 0, -1, false)
  vim.api.nvim_win_close(window, true)
  return table.concat(lines, "\n")
end

local function edited(what, edit)
  local before = vim.b.changedtick
  edit()
  await(function()
    return vim.b.changedtick ~= before
  end, what)
end

function does.fix(task)
  go(task, task.column)
  vim.ui.select = function(actions, options, choose)
    for at, action in ipairs(actions) do
      if options.format_item(action) == task.with then
        return choose(action, at)
      end
    end
    error(task.with .. " is not among " .. vim.inspect(vim.tbl_map(options.format_item, actions)))
  end
  edited("the fix", vim.lsp.buf.code_action)
end

function does.format()
  if vim.lsp.buf.format then
    vim.lsp.buf.format({ timeout_ms = 60000 })
  else
    vim.lsp.buf.formatting_sync(nil, 60000)
  end
end

function does.rename(task)
  go(task, task.column)
  edited("the new name", function()
    vim.lsp.buf.rename(task.with)
  end)
end

local function try(task)
  vim.cmd("edit " .. task.file)
  -- What is saved is what the edits have made: no more ends of last lines than those.
  vim.bo.fixendofline = false
  vim.bo.endofline = vim.bo.endofline and vim.fn.getfsize(task.file) > 0
  local function count(n)
    await(function()
      return #vim.diagnostic.get(0) == n
    end, n .. " diagnostics")
  end
  count(task.told)
  local answer = { told = told() }
  answer.said = does[task["do"]](task)
  vim.cmd("wall")
  count(task.left)
  return answer
end

local function all()
  vim.o.hidden = true
  vim.o.swapfile = false
  vim.o.completeopt = "menuone,noselect"
  local answers = vim.empty_dict()
  for _, task in ipairs(vim.fn.json_decode(vim.fn.readfile("tasks.json"))) do
    local done, answer = xpcall(try, debug.traceback, task)
    answers[task.file] = done and answer or { error = answer, seen = told() }
  end
  vim.fn.writefile({ vim.fn.json_encode(answers) }, "answers.json")
  vim.cmd("qall!")
end

main = coroutine.create(function()
  local done, failure = xpcall(all, debug.traceback)
  if not done then
    vim.fn.writefile(vim.split(failure, "\n"), "failure.txt")
    vim.cmd("cquit!")
  end
end)
coroutine.resume(main)
