" Does what tasks.json asks for as a user would, one file after the other, and writes answers.json.
set hidden noswapfile encoding=utf-8 fileencodings=utf-8 completeopt=menuone
let g:ale_hover_to_preview = 1

" Vim takes messages while it sleeps.
function! Await(wanted, what) abort
  let l:begun = reltime()
  while !a:wanted()
    if reltimefloat(reltime(l:begun)) > 60
      throw 'waited in vain for ' . a:what
    endif
    sleep 5m
  endwhile
endfunction

function! Marked(one) abort
  return strpart(getline(a:one.lnum), a:one.col - 1, a:one.end_col - a:one.col + 1)
endfunction

function! Told() abort
  return map(copy(ale#engine#GetLoclist(bufnr(''))), '[Marked(v:val), split(v:val.text, " help: ")[0]]')
endfunction

function! Go(task, column) abort
  call cursor(a:task.line, byteidx(getline(a:task.line), a:column) + 1)
endfunction

" What a person would answer is in the place of what asks for it.
function! Instead(task) abort
  runtime autoload/ale/util.vim
  let g:asked = a:task.with
  function! ale#util#Input(message, value, ...) abort
    let l:offered = matchlist(a:message, '\v(\d+)\) \V' . g:asked . '\v\n')
    return a:message =~# '^New name' ? g:asked : empty(l:offered) ? '' : l:offered[1]
  endfunction
endfunction

" Chooses from what the function of the configuration offers, once it does: keys that are typed before would end it.
function! Choose(findstart, base) abort
  let l:found = MotionScriptComplete(a:findstart, a:base)
  if !a:findstart
    let g:offered = map(copy(l:found), 'v:val.word')
    let l:at = index(g:offered, g:asked)
    call feedkeys(l:at < 0 ? "\<C-e>" : repeat("\<C-n>", l:at) . "\<C-y>", 'n')
  endif
  return l:found
endfunction

let g:does = {}

function! g:does.diagnose(task) abort
endfunction

function! g:does.complete(task) abort
  call Go(a:task, max([a:task.column - 1, 0]))
  let [g:asked, g:offered] = [a:task.with, []]
  setlocal omnifunc=Choose
  call feedkeys((a:task.column > 0 ? 'a' : 'i') . "\<C-x>\<C-o>", 'ntx')
  if index(g:offered, a:task.with) < 0
    throw a:task.with . ' is not among ' . string(g:offered)
  endif
endfunction

function! g:does.hover(task) abort
  call Go(a:task, a:task.column)
  ALEHover
  let l:Shown = {-> filter(range(1, winnr('$')), 'getwinvar(v:val, "&previewwindow")')}
  call Await({-> !empty(l:Shown())}, 'the window that says it')
  let l:said = join(getbufline(winbufnr(l:Shown()[0]), 1, '$'), "\n")
  pclose
  return l:said
endfunction

function! Edited(what) abort
  let l:before = b:changedtick
  return Await({-> b:changedtick != l:before}, a:what)
endfunction

function! g:does.fix(task) abort
  call Go(a:task, a:task.column)
  call Instead(a:task)
  ALECodeAction
  call Edited('the fix')
endfunction

function! g:does.format(task) abort
  let g:formatted = 0
  autocmd User ALEFixPost ++once let g:formatted = 1
  ALEFix
  call Await({-> g:formatted}, 'the new form')
endfunction

function! g:does.rename(task) abort
  call Go(a:task, a:task.column)
  call Instead(a:task)
  ALERename
  call Edited('the new name')
endfunction

function! Try(task) abort
  execute 'edit' a:task.file
  " What is saved is what the edits have made; but whether the last line has an end is for Vim alone to say.
  let &l:fixendofline = a:task.do ==# 'format'
  let &l:endofline = &l:endofline && getfsize(a:task.file) > 0
  let l:Count = {n -> Await({-> len(ale#engine#GetLoclist(bufnr(''))) == n}, n . ' diagnostics')}
  call l:Count(a:task.told)
  let l:answer = {'told': Told()}
  let l:said = g:does[a:task.do](a:task)
  if type(l:said) == v:t_string
    let l:answer.said = l:said
  endif
  wall
  call l:Count(a:task.left)
  return l:answer
endfunction

let s:answers = {}
for s:task in json_decode(join(readfile('tasks.json'), "\n"))
  try
    let s:answers[s:task.file] = Try(s:task)
  catch
    let s:answers[s:task.file] = {'error': v:exception, 'at': v:throwpoint, 'seen': Told(), 'lines': getline(1, '$')}
  endtry
endfor
call writefile([json_encode(s:answers)], 'answers.json')
qall!
