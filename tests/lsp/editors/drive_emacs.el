;; Does what tasks.json asks for as a user would, one file after the other, and writes answers.json.  How that is done
;; with a client, its own file says: `drive-join', `drive-told', `drive-hover', `drive-fix', `drive-format',
;; `drive-rename', and `drive-completions' for what `completion-at-point' asks.
(require 'json)
(require 'cl-lib)

(setq create-lockfiles nil
      make-backup-files nil
      enable-local-variables nil
      mode-require-final-newline nil) ; what is saved is what the edits have made
(prefer-coding-system 'utf-8)

(defun drive-await (what wanted)
  "Let Emacs go on until WANTED returns something; WHAT says what that is."
  (let ((begun (float-time)) found)
    (while (not (setq found (funcall wanted)))
      (when (> (- (float-time) begun) 60)
        (error "Waited in vain for %s" what))
      (accept-process-output nil 0.02))
    found))

(defun drive-count (n)
  "Wait until N diagnostics are told."
  (drive-await (format "%d diagnostics, has %S" n (drive-told)) (lambda () (= n (length (drive-told))))))

(defun drive-go (task)
  "Go to where the cursor of TASK is."
  (goto-char (point-min))
  (forward-line (1- (alist-get 'line task)))
  (forward-char (alist-get 'column task)))

(defun drive-complete (chosen)
  "Choose CHOSEN from what is offered, as what shows completions does."
  (pcase-let* ((`(,start ,end ,table . ,more) (drive-completions))
               (offered (all-completions (buffer-substring-no-properties start end) table
                                         (plist-get more :predicate)))
               (found (or (cl-find chosen offered :test #'string=)
                          (error "%s is not among %S" chosen (mapcar #'substring-no-properties offered)))))
    (delete-region start end)
    (insert found)
    (funcall (plist-get more :exit-function) found 'finished)))

(defun drive-choosing (chosen act)
  "Call ACT, and answer CHOSEN where it asks for a choice."
  (cl-letf (((symbol-function 'completing-read)
             (lambda (_prompt offered &rest _)
               (or (car (assoc chosen offered)) (error "%s is not among %S" chosen (mapcar #'car offered))))))
    (funcall act)))

(defun drive-do (task)
  "Do what TASK asks for; return what is shown."
  (drive-go task)
  (let ((with (alist-get 'with task)))
    (pcase (alist-get 'do task)
      ("complete" (drive-complete with) nil)
      ("hover" (drive-hover))
      ("fix" (drive-choosing with #'drive-fix) nil)
      ("format" (drive-format) nil)
      ("rename" (drive-rename with) nil))))

(defun drive-try (task)
  "Return what comes of TASK."
  (find-file (alist-get 'file task))
  (drive-join)
  (drive-count (alist-get 'told task))
  (let* ((told (drive-told)) (said (drive-do task)))
    (save-some-buffers t)
    (drive-count (alist-get 'left task))
    `((told . ,(vconcat told)) ,@(when said `((said . ,(substring-no-properties said)))))))

(defun drive ()
  "Do all."
  (let* ((json-array-type 'list)
         (tasks (json-read-file "tasks.json"))
         (answers (mapcar (lambda (task)
                            (cons (intern (alist-get 'file task))
                                  (condition-case failure
                                      (drive-try task)
                                    (error `((error . ,(format "%S" failure)) (lines . ,(buffer-string)))))))
                          tasks)))
    (with-temp-file "answers.json"
      (insert (json-encode answers)))
    (kill-emacs)))
